#include "image/exr_context.h"

#include <stdio.h>
#include <string.h>

#include "image/read.h"

static void keep_complaint(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)code;
    void *user = NULL;
    if (exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user) return;
    exr_complaint *complaint = user;
    if (complaint->text[0]) return;
    snprintf(complaint->text, sizeof complaint->text, "%s", message);
    complaint->text[strcspn(complaint->text, "\r\n")] = 0;
}

exr_context_initializer_t exr_quiet(exr_complaint *complaint)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = keep_complaint;
    init.user_data = complaint;
    init.max_image_width = init.max_image_height = IMAGE_MAX_SIDE;
    init.max_tile_width = init.max_tile_height = IMAGE_MAX_SIDE;
    init.flags = EXR_CONTEXT_FLAG_SILENT_HEADER_PARSE | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return init;
}

status exr_fail(status s, const char *verb, const char *path, const exr_complaint *complaint, exr_result_t code)
{
    if (code == EXR_ERR_OUT_OF_MEMORY) s = ERROR_MEMORY;
    return fail(s, "cannot %s %s: %s", verb, path,
                complaint->text[0] ? complaint->text : exr_get_default_error_message(code));
}

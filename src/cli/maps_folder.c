/* SPDX-License-Identifier: MIT */
#include "cli/maps_folder.h"

#include "base/file.h"
#include "command/photos.h"
#include "merlin/image.h"
#include "merlin/sequences.h"

status maps_folder_take(int argc, char *const *argv, const char **input)
{
    if (argc == 0) return fail(MERLIN_WRONG_USE, "no folder of maps given");
    if (argc > 1) return fail(MERLIN_WRONG_USE, "one folder at a time, not also %s", argv[1]);
    *input = photo_without_maps_name(argv[0]);
    return OK;
}

status maps_folder_check(const char *input, const char *remedy)
{
    if (!file_exists(input)) return fail(MERLIN_BAD_INPUT, "there is no folder %s", input);
    if (merlin_sequence_is(input))
        return fail(MERLIN_BAD_INPUT,
                    "%s holds a sequence, whose maps are in a folder of each frame: name one, %s/frame_...", input,
                    input);
    if (file_is_folder(input)) return OK;
    merlin_image photo = {0};
    const bool is_photo = merlin_image_read(input, &photo, NULL) == OK;
    merlin_image_free(&photo);
    if (!is_photo) return fail(MERLIN_BAD_INPUT, "%s is neither a folder of maps nor a photograph", input);
    return fail(MERLIN_BAD_INPUT, "%s is no folder of maps: merlin estimate %s %s", input, input, remedy);
}

#include "cli/check_files.h"

#include "base/file.h"
#include "estimate/staging.h"

status check_photo_and_mask(const char *photo, const char *mask)
{
    if (!file_exists(photo)) return fail(ERROR_INPUT, "there is no photograph %s", photo);
    if (mask && !file_exists(mask)) return fail(ERROR_INPUT, "there is no mask %s", mask);
    return OK;
}

status check_output(const char *folder)
{
    staging *t;
    status s = staging_begin(folder, NULL, &t);
    return s == OK ? staging_abort(t, OK) : s;
}

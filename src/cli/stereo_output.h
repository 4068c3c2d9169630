/* The files of merlin stereo: maps, pictures for people, meshes and a report. */
#ifndef MERLIN_CLI_STEREO_OUTPUT_H
#define MERLIN_CLI_STEREO_OUTPUT_H

#include <cJSON.h>

#include "base/skipped.h"
#include "base/warnings.h"
#include "cli/mesh_file.h"
#include "estimate/staging.h"
#include "stereo/capture.h"

typedef struct stereo_result {
    img normal, albedo, depth, mask; /* 3, 3, 1, 1 channels; albedo in [0, 1] */
    img error;                       /* 1 */
    const char *error_name;          /* what error is: the residual, or the spread in degrees */
    float error_white;               /* shown as white */
    pst_camera camera;
    warnings doubts;
    skipped_files skipped; /* of the folder */
} stereo_result;

void stereo_result_free(stereo_result *r);

typedef struct stereo_files {
    const char *folder;
    const char *const *inputs; /* as in staging_begin */
    mesh_names mesh;           /* none: mesh.ply, mesh.obj and mesh.glb in the folder */
    int (*stop)(void);
} stereo_files;

/* maps.exr, normal.png (16 bits), albedo.png, depth.png, mask.png, error.png, overview.png, report.json and the meshes,
 * wherever those are wanted: all, their paths added to *written, or, after a failure to write, none. */
status stereo_write(const stereo_files *files, const stereo_result *r, const cJSON *report, staged_files *written);

/* The surface turned by 45 degrees about the vertical axis and lit from the camera: side × side, 1 channel, linear. */
status stereo_side_view(const stereo_result *r, int side, img *out);

#endif

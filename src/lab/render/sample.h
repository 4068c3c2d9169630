/* SPDX-License-Identifier: MIT */
/* A rendered training sample, in memory and as a multi-layer OpenEXR file (half float, ZIP).
 *
 * Space, light and ranges as in docs/conventions.md: camera at the origin looking along -z, depth is -z, normals unit
 * with n_z > 0, albedo and roughness in [0, 1], radiance linear. Everything outside the mask is zero. At silhouettes
 * the maps are averages over the visible part of the object in the pixel (normals renormalized), and mask is coverage;
 * images are multiplied by coverage. */
#ifndef MERLIN_LAB_RENDER_SAMPLE_H
#define MERLIN_LAB_RENDER_SAMPLE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/vec.h"
#include "image/image.h"
#include "optics/camera.h"

enum { SAMPLE_GENERATOR_VERSION = 3, SAMPLE_MAX_TARGETS = 64, SAMPLE_MAX_LAMPS = 16 };

/* An image under another point light, or under an LED, with cast shadows. */
typedef struct sample_target {
    vec3 light;   /* position in camera space */
    vec3 axis;    /* of an LED: unit, the direction in which it shines most; else 0, 0, 0 */
    float lobe;   /* of an LED: exponent of its fall-off with the cosine of the angle to the axis (optics/led.h) */
    img direct;   /* 3 channels, bounce 1, cast shadows included */
    img indirect; /* 3 channels, bounces 2 and 3 */
} sample_target;

/* An image under another lamp, as bright at the object's middle, (0, 0, -1), as the flash is there. */
typedef struct sample_lamp {
    vec3 at; /* position; for a distant lamp, whose light is parallel, the unit direction toward it */
    bool distant;
    float radius;   /* 0: a point; else of a disc that faces the middle; for a distant lamp the tangent of its angular
                     * radius */
    img direct;     /* 3 channels, bounce 1, cast shadows included */
    img indirect;   /* 3 channels, bounces 2 and 3 */
    img visibility; /* 1: share of bounce 1 that other parts of the object let through; 0 where there would be none */
} sample_lamp;

typedef struct sample {
    img albedo;           /* 3 */
    img normal;           /* 3 */
    img roughness;        /* 1 */
    img depth;            /* 1 */
    img mask;             /* 1, coverage in [0, 1] */
    img direct;           /* 3, point light at the camera, bounce 1 */
    img indirect;         /* 3, bounces 2 + 3 */
    img bounce2, bounce3; /* 3 each; empty (data NULL) unless requested */
    img env;              /* 3, lit by the environment (direct and bounces) without a point light */
    float sh[9][3];       /* radiance SH of that environment, order L00, L1-1, L10, L11, L2-2, L2-1, L20, L21, L22 */
    sample_target *targets;
    int target_count;
    sample_lamp *lamps;
    int lamp_count;
    vec3 light;         /* of direct and indirect: the origin */
    float light_power;  /* Φ */
    float fov;          /* horizontal, degrees */
    camera_slant slant; /* of a crop (optics/camera.h) */
    uint64_t seed, index;
    int generator_version;
    char shape[32]; /* class of object: "union", "blend", "revolution", "superquadric", "relief", "mesh" */
} sample;

/* Returns a unit normal as samples store it, which also faces the image plane; off the axis, facing the eye does not
 * imply that. */
static inline vec3 sample_normal(vec3 n)
{
    return n.z < 0.01f ? vec3_normalize(vec3_make(n.x, n.y, 0.01f)) : n;
}

void sample_free(sample *s);
/* Writes a sample: channels albedo.R/.G/.B, normal.X/.Y/.Z, roughness.Y, depth.Z, mask.A, direct.*, indirect.*,
 * bounce2.*, bounce3.*, env.*, target00.direct.* …, lamp00.direct.*, lamp00.indirect.*, lamp00.visibility.Y …; the rest
 * as attributes, of which target00.axis and target00.lobe are absent where they are zero. Written to a temporary name,
 * then renamed. */
status sample_write(const char *path, const sample *s);
/* Reads all layers in the file. Refuses files that lack a layer that every sample has, contain NaN or infinity, or give
 * a target a lobe about no unit axis. */
status sample_read(const char *path, sample *out);
/* Reads everything but env, bounces and targets: what training needs, faster. */
status sample_read_training(const char *path, sample *out);
/* Reads what training needs, and env. Refuses files rendered without it. */
status sample_read_training_environment(const char *path, sample *out);
/* Reads only the environment's coefficients, from the file's header. Refuses files rendered without them. */
status sample_read_sh(const char *path, float sh[9][3]);
/* Reads only generator_version, from the file's header. */
status sample_read_version(const char *path, int *version);

/* Lists the paths of a folder's samples, at least one, sorted; freed by file_list_free. */
status sample_list(const char *folder, char ***paths, size_t *count);

/* Returns "folder/000123.exr", malloc'ed. */
char *sample_path(const char *folder, uint64_t index);

#endif

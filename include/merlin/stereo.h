/* SPDX-License-Identifier: MIT */
/* merlin/stereo: photometric stereo, the surface of an object from pictures of it under many lights.
 *
 *     merlin_capture *capture;
 *     merlin_surface surface;
 *
 *     if (merlin_capture_read("owl", NULL, &capture) || merlin_stereo(capture, NULL, &surface))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * merlin/mesh.h makes triangles of it. One camera, one still object, one light at a time. Images, space, errors and who
 * frees what are as in merlin.h. */
#ifndef MERLIN_STEREO_H
#define MERLIN_STEREO_H

#include <merlin/camera.h>
#include <merlin/image.h>
#include <merlin/status.h>
#include <merlin/warnings.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- pictures and lights ---- */

typedef enum merlin_lighting {
    MERLIN_DISTANT_LIGHTS, /* their directions are known */
    MERLIN_NEAR_LIGHTS,    /* their positions are known */
    MERLIN_UNKNOWN_LIGHTS  /* nothing is known but, perhaps, how strong they are */
} merlin_lighting;

/* A diffuse white surface appears with the value intensity * cos, or near ones' intensity * cos / distance^2. */
typedef struct merlin_light {
    float direction[3]; /* distant: from the object to the light. Near: where an LED points; 0, 0, 0: nowhere special */
    float position[3];  /* near: in the camera's space, any unit */
    float intensity[3]; /* a channel each, the first alone for grey pictures, 1e-15 to 1e15; 0, 0, 0: 1 */
    float lobe;         /* near: the exponent of an LED's fall-off with the cosine of the angle to its direction */
} merlin_light;

typedef struct merlin_capture merlin_capture;

/* Where a folder's files are. All zero is the usual case. */
typedef struct merlin_capture_files {
    const char *lights;  /* lights.txt or an .lp file (for the pictures in the order of their names, if it names none
                            of them); NULL: the folder's, or its LUCES or DiLiGenT layout */
    const char *mask;    /* NULL: the folder's mask.png or *.mask.png, else what is brighter than black and than a dark
                          * edge of the pictures */
    const char *ambient; /* a picture without any of the lights; NULL: the folder's ambient.png or the like, if any */
    int near_lights;     /* 1: the list holds positions in the camera's space; an .lp file's are about the object, how
                          * far from the camera merlin_stereo finds if it is not known, unless all have z below 0 */
    int unknown_lights;  /* 1: wherever lights are said to be, they are not known */
    int linear;          /* 1: 8-bit pictures are linear, not sRGB, whatever a profile says */
    float field_of_view; /* horizontal, degrees; 0: not known */
    float distance;      /* of the object from the camera, in the unit of the lights' positions; 0: not known. For near
                          * lights or a known field of view alone */
    int (*stop)(void);   /* asked between pictures; returning nonzero ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* told of the pictures that are read, "reading"; may be NULL */
    void *progress_context;
} merlin_capture_files;

/* PNG, JPEG, TIFF, EXR or raw pictures, else WebP, HEIC or HDR ones, and the lights they were taken under; 16-bit ones
 * are linear unless they say otherwise (a colour profile, a PNG's chunk, EXIF), raw ones always. files NULL: the usual
 * case. */
merlin_status merlin_capture_read(const char *folder, const merlin_capture_files *files, merlin_capture **out);

/* What holds for all pictures that are added from memory. */
typedef struct merlin_capture_params {
    merlin_lighting lighting;
    int unknown_intensities; /* 1: how strong the lights are is not known */
    float field_of_view;     /* horizontal, degrees; 0: the camera is far away (60 degrees with near lights) */
    float distance;          /* of the object from the camera, in the unit of the lights' positions; 0: not known */
} merlin_capture_params;

/* Without pictures yet. params NULL: distant lights of known intensities, a camera far away. mask: 1 channel, the
 * object where it is at least one half; NULL: what is brighter than black and than a dark edge of the pictures. */
merlin_status merlin_capture_new(const merlin_capture_params *params, const merlin_image *mask, merlin_capture **out);
/* 1 or 3 channels of linear light in [0, 1], all pictures alike and of the mask's size; from 0.98 on a value counts as
 * saturated. light NULL: nothing is known of it. */
merlin_status merlin_capture_add(merlin_capture *capture, const merlin_image *picture, const merlin_light *light);
void merlin_capture_free(merlin_capture *capture);

/* ---- the surface ---- */

typedef enum merlin_stereo_method {
    MERLIN_STEREO_AUTO,         /* by what is known of the lights: near, robust, semi or uncalibrated */
    MERLIN_STEREO_LS,           /* distant: Lambertian least squares (Woodham 1980) without shadows and saturation */
    MERLIN_STEREO_ROBUST,       /* distant: a specular lobe a pixel; cast shadows as outliers */
    MERLIN_STEREO_NEAR,         /* near: depth and normals by turns */
    MERLIN_STEREO_SEMI,         /* distant: directions known, intensities not */
    MERLIN_STEREO_UNCALIBRATED, /* unknown, distant or near, of one strength or on one albedo */
} merlin_stereo_method;

typedef struct merlin_stereo_params {
    merlin_stereo_method method;
    int keep_edges; /* 1: depth may jump where the normals say so; else it is the least-squares surface of the normals.
                       Lights with places are solved with depth, which may jump in any case */
    int integrate;  /* 1: depth that is solved with the normals is integrated from them once more, held near what it was
                     */
    int iterations; /* of MERLIN_STEREO_NEAR and _SEMI, at most; 0: the method's own */
    int unchecked;  /* 1: the result is not held against other lights, lenses and tones, which takes a part of the time
                     * of solving; its warnings stay empty */
    int (*stop)(void);        /* asked all along; returning nonzero ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* told "solving", then "integrating"; may be NULL */
    void *progress_context;
} merlin_stereo_params;

/* All of the pictures' size, zero where mask is. */
typedef struct merlin_surface {
    merlin_image normal; /* 3, unit, z > 0 toward the camera */
    merlin_image albedo; /* the pictures' channels; relative unless the intensities are known */
    merlin_image depth; /* 1, along -z: in the unit of the distance (1 if that is not known), in pixels for a camera far
                         * away; each separate piece of the mask has its own distance */
    merlin_image residual; /* 1, root mean square of what the fit leaves, as a share of it */
    merlin_image mask;     /* 1, 0 or 1 */
    merlin_camera camera;
    merlin_stereo_method method; /* the one used */
    merlin_light
        *lights; /* light_count, one a picture, as MERLIN_STEREO_SEMI and _UNCALIBRATED found them; else NULL */
    int light_count;
    int lights_near;      /* MERLIN_STEREO_UNCALIBRATED: the lights have positions, too, in the unit of camera.distance
                           * (1 if that is not known) */
    int strengths_unsure; /* MERLIN_STEREO_SEMI on an object too flat, or with too few pictures (3), to tell how strong
                             lights are: normals may be far off */
    int distance_unsure;  /* MERLIN_STEREO_NEAR without a known distance, and with too few lights, or lights too much
                             alike, to tell it: normals may be far off */
    int lights_unsure;    /* MERLIN_STEREO_UNCALIBRATED where the pictures or the object's
                             outline tell them badly: normals may be far off, or bulge where the object recedes */
    merlin_warnings warnings; /* what speaks against the pictures, their lights and the result (docs/json.md has the
                               * codes), these three among it; empty if params.unchecked */
} merlin_surface;

/* params NULL: MERLIN_STEREO_AUTO, least-squares depth. From 3 pictures on (MERLIN_STEREO_UNCALIBRATED: 7) to 1024
 * (MERLIN_STEREO_LS: 4096). Lights that a list has as places about the object are taken for near ones, if the method is
 * MERLIN_STEREO_AUTO or _NEAR, where that explains the pictures better than directions do. */
merlin_status merlin_stereo(const merlin_capture *capture, const merlin_stereo_params *params, merlin_surface *out);
void merlin_surface_free(merlin_surface *surface);

#ifdef __cplusplus
}
#endif

#endif

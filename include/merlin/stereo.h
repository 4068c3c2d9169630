/* SPDX-License-Identifier: MIT */
/* merlin/stereo: photometric stereo, the surface of an object from pictures of it under many lights.
 *
 *     merlin_capture *capture;
 *     merlin_surface surface;
 *     if (merlin_capture_read("owl", NULL, &capture) || merlin_stereo(capture, NULL, &surface))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * merlin/mesh.h makes triangles of it, merlin/surface.h files and maps. A capture has one camera that does not move,
 * one static object, and one light per picture; lights are distant or near, their directions or positions known or
 * unknown. Images, space, errors and ownership are as in merlin.h. */
#ifndef MERLIN_STEREO_H
#define MERLIN_STEREO_H

#include <merlin/camera.h>
#include <merlin/files.h>
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
    MERLIN_UNKNOWN_LIGHTS  /* nothing is known except, possibly, their intensities */
} merlin_lighting;

/* A light. A diffuse white surface has the value intensity * cos, under near lights intensity * cos / distance^2. */
typedef struct merlin_light {
    float direction[3]; /* distant: from the object to the light. Near: axis of an LED; 0, 0, 0: none */
    float position[3];  /* near: in the camera's space, in any unit */
    float intensity[3]; /* of each channel, for grey pictures only the first, 1e-15 to 1e15; 0, 0, 0: 1 */
    float lobe;         /* near: exponent of an LED's fall-off with the cosine of the angle to its axis */
} merlin_light;

typedef struct merlin_capture merlin_capture;

/* Files of a folder, and options. All zeros are the defaults. */
typedef struct merlin_capture_files {
    const char *lights;  /* lights.txt or an .lp file (in the order of the pictures' names, if it names none of them);
                          * NULL: the folder's, or its LUCES or DiLiGenT layout */
    const char *mask;    /* NULL: the folder's mask.png or *.mask.png, else the pixels that are brighter than black and
                          * than a dark edge of the pictures */
    const char *ambient; /* a picture without any of the lights; NULL: the folder's ambient.png or similar, if any */
    int near_lights; /* 1: the list contains positions in the camera's space; those of an .lp file are relative to the
                      * object, and merlin_stereo estimates its distance if it is unknown, unless all have z below 0 */
    int unknown_lights;  /* 1: ignore where lights are listed to be */
    int lights_optional; /* 1: a folder without a list of lights is read, too: its lights are unknown */
    int frames;          /* largest number of frames that are taken from a video, at most 64; 0: 16 */
    int linear;          /* 1: 8-bit pictures are linear, not sRGB, whatever their profiles state */
    float field_of_view; /* horizontal, degrees; 0: for near lights, and in merlin_maps_from_capture, that of the first
                          * picture's EXIF, else unknown */
    float distance;    /* of the object from the camera, in the unit of the lights' positions; 0: unknown. Only for near
                        * lights or a given field of view */
    int (*stop)(void); /* called between pictures; a nonzero result ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* called for the pictures that are read, with "reading"; may be NULL */
    void *progress_context;
} merlin_capture_files;

/* Reads a capture: PNG, JPEG, TIFF, EXR or raw pictures, else WebP, HEIC or HDR ones, and their lights. 16-bit pictures
 * are linear unless they state otherwise (a colour profile, a PNG's chunk, EXIF), raw ones always. The folder may also
 * be a video of an object under a lamp that moves, with unknown_lights or lights_optional: its frames whose light
 * differs most are read. files NULL: the defaults. */
merlin_status merlin_capture_read(const char *folder, const merlin_capture_files *files, merlin_capture **out);
/* Reads a capture of these pictures, in this order, under unknown lights; no files beside them are read. */
merlin_status merlin_capture_read_pictures(const char *const *pictures, size_t count, const merlin_capture_files *files,
                                           merlin_capture **out);

/* Properties of all pictures that are added from memory. */
typedef struct merlin_capture_params {
    merlin_lighting lighting;
    int unknown_intensities; /* 1: the lights' intensities are unknown */
    float field_of_view;     /* horizontal, degrees; 0: the camera is far away (60 degrees with near lights) */
    float distance;          /* of the object from the camera, in the unit of the lights' positions; 0: unknown */
} merlin_capture_params;

/* Makes a capture without pictures. params NULL: distant lights of known intensities, a camera far away. mask: 1
 * channel, the object from one half on; NULL: pixels brighter than black and than a dark edge of the pictures. */
merlin_status merlin_capture_new(const merlin_capture_params *params, const merlin_image *mask, merlin_capture **out);
/* Adds a picture: 1 or 3 channels of linear light in [0, 1], the same for all pictures, of the mask's size; values from
 * 0.98 on count as saturated. light NULL: it is unknown. */
merlin_status merlin_capture_add(merlin_capture *capture, const merlin_image *picture, const merlin_light *light);
/* Adds a picture's file, read as those of a folder are. linear: 1: 8-bit values are linear, not sRGB. */
merlin_status merlin_capture_add_file(merlin_capture *capture, const char *path, int linear, const merlin_light *light);
/* Returns what is known of the lights. */
merlin_lighting merlin_capture_lighting(const merlin_capture *capture);
void merlin_capture_free(merlin_capture *capture);

/* ---- the surface ---- */

typedef enum merlin_stereo_method {
    MERLIN_STEREO_AUTO,         /* depends on what is known about the lights: near, robust, semi or uncalibrated */
    MERLIN_STEREO_LS,           /* distant: Lambertian least squares (Woodham 1980) without shadows and saturation */
    MERLIN_STEREO_ROBUST,       /* distant: a specular lobe per pixel; cast shadows as outliers */
    MERLIN_STEREO_NEAR,         /* near: depth and normals alternately */
    MERLIN_STEREO_SEMI,         /* distant: directions known, intensities not */
    MERLIN_STEREO_UNCALIBRATED, /* unknown, distant or near, of one intensity or on one albedo */
    MERLIN_STEREO_NFPS,         /* near: by a network, merlin_stereo_by_network alone (after Fast-NFPS, Lichy et al.
                                 * 2022), in fixed time; gloss counts as outliers of the albedo */
} merlin_stereo_method;

typedef struct merlin_stereo_params {
    merlin_stereo_method method;
    int keep_edges; /* 1: depth may jump where the normals indicate it; else it is the least-squares surface of the
                     * normals. With lights of known positions depth may jump in any case */
    int integrate;  /* 1: depth that was found together with the normals is integrated from them again, close to what it
                     * was */
    int iterations; /* largest number for MERLIN_STEREO_NEAR and _SEMI; 0: the method's default */
    int unchecked; /* 1: the result is not compared with other lights, lenses and tone curves, which takes a part of the
                    * time of solving; its warnings stay empty */
    int (*stop)(void);        /* called frequently; a nonzero result ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* called with "solving", then "integrating"; may be NULL */
    void *progress_context;
} merlin_stereo_params;

/* Returns the name of a method in the command and in reports, such as "robust"; "unknown" for other values. */
const char *merlin_stereo_method_name(merlin_stereo_method method);

/* Statistics of the values of pixels; zeros if there are none. */
typedef struct merlin_statistics {
    double mean, median;
    size_t count;
} merlin_statistics;

/* Figures of a surface from one photograph (merlin_stereo_from_maps in surface.h). */
typedef struct merlin_relit_photo {
    int lights;                   /* relit pictures; 0: the surface is of a capture */
    int subsets, lights_a_subset; /* random subsets of them, each solved separately */
    char model[64];               /* model that relit the photograph */
    size_t pixels;                /* the object's pixels */
    size_t pixels_left;           /* those with the photograph's normals, because the subsets contradict each other */
    double spread;                /* mean of the residual, degrees */
    double angle;                 /* mean angle between the solved normals and the photograph's, degrees */
} merlin_relit_photo;

/* A surface; all images have the pictures' size, and are zero outside the mask. */
typedef struct merlin_surface {
    merlin_image normal;   /* 3 channels, unit, z > 0 toward the camera */
    merlin_image albedo;   /* the pictures' channels; relative unless the intensities are known */
    merlin_image depth;    /* 1 channel, along -z: in the unit of the distance (1 if that is unknown), in pixels for a
                            * camera far away; each separate piece of the mask has its own distance */
    merlin_image residual; /* 1 channel, root mean square residual of the fit, relative to it; of one photograph the
                            * root mean square angle of the subsets' normals to their mean, in degrees */
    merlin_image spread; /* 1 channel, standard error of the normals in degrees, by leaving out single pictures: near 0
                          * where all of them agree, 90 where too few tell; MERLIN_STEREO_LS: no data */
    merlin_image mask;   /* 1 channel, 0 or 1 */
    merlin_camera camera;
    merlin_stereo_method method; /* method that was used */
    int by_network; /* MERLIN_STEREO_NEAR and _NFPS: a network's surface is the result, or where its search began */
    merlin_light
        *lights; /* light_count, one per picture, as MERLIN_STEREO_SEMI and _UNCALIBRATED estimate them; else NULL */
    int light_count;
    int lights_near;      /* MERLIN_STEREO_UNCALIBRATED: whether the lights also have positions, in the unit of
                           * camera.distance (1 if that is unknown) */
    int strengths_unsure; /* MERLIN_STEREO_SEMI: the object is too flat, or the pictures are too few (3), to determine
                           * the lights' intensities: normals may have large errors. MERLIN_STEREO_UNCALIBRATED:
                           * the lights do not seem to be equally strong */
    int distance_unsure;  /* MERLIN_STEREO_NEAR without a known distance: the lights are too few, or too similar, to
                           * determine it: normals may have large errors */
    int lights_unsure;    /* MERLIN_STEREO_UNCALIBRATED: the pictures or the object's outline hardly determine them:
                           * normals may have large errors, or be convex where the object is concave */
    merlin_warnings warnings; /* what contradicts the pictures, their lights and the result (docs/json.md lists the
                               * codes), including these three; empty if params.unchecked */
    int keep_edges;           /* params.keep_edges */
    int picture_count;
    char **picture_names;           /* picture_count file names; "light 0" and so on for pictures from memory */
    int lights_in_order;            /* 1: the list of lights names no pictures, and was matched by the order of names */
    merlin_skipped_files skipped;   /* files of the capture's folder that were skipped */
    merlin_statistics normal_error; /* angles to the true normals, degrees, for layouts that contain these */
    struct {
        double read, solve, integrate, total;
    } seconds;
    merlin_relit_photo relit;
} merlin_surface;

/* Computes the surface. params NULL: MERLIN_STEREO_AUTO, least-squares depth. From 3 pictures on
 * (MERLIN_STEREO_UNCALIBRATED: 7) to 1024 (MERLIN_STEREO_LS: 4096). Lights listed relative to the object count as near,
 * with MERLIN_STEREO_AUTO or _NEAR, if that explains the pictures better than directions do. */
merlin_status merlin_stereo(const merlin_capture *capture, const merlin_stereo_params *params, merlin_surface *out);
void merlin_surface_free(merlin_surface *surface);

/* ---- near lights by a network ---- */

typedef struct merlin_near_network merlin_near_network;

/* Opens weights of a network of near lights, such as models/merlin-nfps.safetensors. MERLIN_BAD_INPUT if they are
 * another model's. */
merlin_status merlin_near_network_open(const char *weights, merlin_near_network **out);
void merlin_near_network_close(merlin_near_network *network);
/* Computes the surface like merlin_stereo, with a network besides; NULL: without. MERLIN_STEREO_NFPS: its normals and
 * depth, from the pictures at up to 512 pixels a side and at most 64 of them, evenly chosen. MERLIN_STEREO_NEAR, also
 * as AUTO chooses it: each pixel's fit begins with the network's normal and depth, which few lights do not tell by
 * themselves, unless there are eight lights or more and what is found without it explains the pictures far better.
 * Other methods do without it. */
merlin_status merlin_stereo_by_network(const merlin_near_network *network, const merlin_capture *capture,
                                       const merlin_stereo_params *params, merlin_surface *out);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
/* merlin: one photograph of an object, taken apart into its material and lit again from elsewhere.
 *
 *     merlin_image photo, alpha;
 *     merlin_model *model;
 *     merlin_maps maps;
 *     merlin_image relit;
 *     const float from_the_left[3] = {-0.8f, 0.3f, -0.5f};
 *
 *     if (merlin_image_read("cup.jpg", &photo, &alpha) || merlin_model_open("merlin-point.safetensors", &model) ||
 *         merlin_estimate(model, &photo, &alpha, NULL, &maps) ||
 *         merlin_relight(model, &maps, from_the_left, MERLIN_BY_BRDF, &relit) ||
 *         merlin_maps_write(model, &maps, "cup.merlin") || merlin_image_write("cup-from-left.png", &relit))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * From pictures under many lights to a surface: stereo.h.
 *
 * The photograph is best taken with the camera's flash: the model was trained on objects lit by a light beside the
 * lens.
 *
 * Images are float, interleaved, rows from the top, on linear sRGB primaries. Space: the camera is at the origin and
 * looks along -z, x right, y up; the object stands near (0, 0, -1). The square `crop` around the object counts as the
 * whole frame of a camera that looks at its centre: as wide as the photograph's lens makes it, or 60 degrees where that
 * is not known.
 *
 * Functions return MERLIN_OK (0) or what went wrong; merlin_error() then says it in words, per thread. What a function
 * fills in is yours to free; it is overwritten, not freed first, and after a failure it is empty. Pointers must not be
 * NULL unless a comment says so (MERLIN_WRONG_USE); what frees or closes takes NULL, and then does nothing. Nothing is
 * printed, nothing exits. There are no globals but how many threads work: a model may be used from several threads
 * (runs through one model take turns). Processes do not share it: where the parent has called the library, what fork
 * leaves in the child lacks the threads of OpenMP and would wait for them for ever, so let the child exec, or fork
 * before the first call. */
#ifndef MERLIN_MERLIN_H
#define MERLIN_MERLIN_H

#include <merlin/image.h>
#include <merlin/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the model ---- */

typedef struct merlin_model merlin_model;

merlin_status merlin_model_open(const char *weights, merlin_model **out);
/* Gives a model of any light another for photographs that are lit by a flash alone, which knows that light better:
 * merlin_estimate asks the first what it sees, and maps.model says which one the maps are by. MERLIN_WRONG_USE if the
 * first knows one light alone, or has such another. The weights are read when a photograph first asks for them. */
merlin_status merlin_model_add_flash(merlin_model *model, const char *weights);
void merlin_model_close(merlin_model *model);
const char *merlin_model_name(const merlin_model *model); /* as long as the model is open; "" for NULL */

/* ---- from a photograph to maps ---- */

/* Facts of how a photograph was taken, as far as they are known. */
typedef enum merlin_flash { MERLIN_FLASH_UNKNOWN, MERLIN_FLASH_NONE, MERLIN_FLASH_FIRED } merlin_flash;

typedef struct merlin_shot {
    merlin_flash flash;
    float focal_35mm; /* the focal length in mm whose picture on 36 x 24 mm has as wide a diagonal; 0: unknown */
    int reduced;      /* so many of the file's pixels a side became one, as merlin_image_read has it: 0 or 1 for most */
    int frames;       /* of an animation, whose first alone is read: 0 or 1 for most */
} merlin_shot;

/* By the EXIF of a JPEG, PNG, WebP, HEIC, TIFF or raw picture, and the file's head; unknown without. */
merlin_status merlin_shot_read(const char *path, merlin_shot *out);

/* Help for the search for the object, where there is no mask: coordinates in whole pixels of the photograph, from its
 * upper left corner. */
enum { MERLIN_MOST_POINTS = 16 };
typedef struct merlin_hint {
    int point_count;
    struct {
        int x, y;
    } point[MERLIN_MOST_POINTS]; /* pixels of the object */
    struct {
        int x, y, width, height;
    } box; /* holds all of the object, the tighter the better; width 0: none */
} merlin_hint;

/* What lights a photograph, as a model of any light sees it; zeros where the model knows one light alone. Strengths are
 * in the photograph's radiance (its values times gain): 1 is a lamp of power 5.95 at distance 1. */
typedef struct merlin_found_light {
    int known;              /* the model tells */
    float flash;            /* the strength of a flash at the lens; 0: none */
    float lamp[3];          /* unit, from the object's middle, (0, 0, -1), toward the strongest lamp; zeros: none */
    float lamp_sure;        /* how sure the model is that there is one, in [0, 1] */
    float lamp_distance;    /* from there; 0: far away, its light is parallel */
    float lamp_strength[3]; /* in the object's middle, by channel */
    float rest[9][3];       /* everything else: spherical harmonics of radiance, bands 0 to 2 */
} merlin_found_light;

typedef struct merlin_params {
    int size;  /* side of the square the network sees: a multiple of 32, from 64 to 512. It was trained at 256; of
                * more it takes fine normals alone, if the photograph shows the object so large */
    int views; /* in how many of the square's eight orientations the network sees it; the mean is taken */
    int auto_exposure; /* 1: bring a photograph that is too dark or too bright, up to a million times (floats may be in
                        * any unit), to the brightness of the training data */
    float exposure;    /* EV on top if auto_exposure is 0, within 20 */
    int (*stop)(void); /* asked between stages; returning nonzero ends the work with MERLIN_STOPPED; may be NULL */
    merlin_shot shot;  /* of the photograph: its lens, and doubts in its maps */
    int flash;         /* 1: its light was a flash at the lens and nothing else, which models of any light are told */
    float fov;         /* degrees that the photograph is wide, from 1 to 150; 0: by shot, if that knows the lens */
    merlin_hint hint;  /* where the object is, if it is searched for; MERLIN_WRONG_USE with a mask */
} merlin_params;

merlin_params merlin_params_default(void); /* 512, 4 views, automatic, never stopped */

typedef enum merlin_mask_source { MERLIN_MASK_GIVEN, MERLIN_MASK_FOUND } merlin_mask_source;

typedef struct merlin_timing {
    double mask, prepare, choose, compile, network, upsample; /* seconds; choose: which of two models it is for */
} merlin_timing;

/* Why maps may be wrong, the gravest first: each a bit of merlin_maps' doubts. A model knows one object, and most know
 * one light, a flash at the lens; of anything else they make maps, too. */
typedef enum merlin_doubt {
    MERLIN_DOUBT_NO_OBJECT = 1 << 0,       /* the object found, or the mask given, fills the photograph */
    MERLIN_DOUBT_BURNT_OUT = 1 << 1,       /* burnt_out is a tenth or more */
    MERLIN_DOUBT_OBJECT_UNSURE = 1 << 2,   /* mask_confidence is below 0.5 */
    MERLIN_DOUBT_LIGHT_ELSEWHERE = 1 << 3, /* light_elsewhere, or light if that is known, says: not by a flash alone */
    MERLIN_DOUBT_NO_FLASH = 1 << 4,        /* params.shot says that no flash fired */
    MERLIN_DOUBT_HOLLOW = 1 << 5,          /* along the outline the normals turn inward, as of a bowl */
    MERLIN_DOUBT_DRAWING = 1 << 6,         /* most of it are areas of one colour: a drawing or a screenshot */
    MERLIN_DOUBT_LENS_NARROW = 1 << 7,     /* fov is below 5 */
    MERLIN_DOUBT_LENS_WIDE = 1 << 8,       /* fov is above 95 */
    MERLIN_DOUBT_DARK = 1 << 9,            /* too few shades: nearly black */
    MERLIN_DOUBT_OBJECT_CUT = 1 << 10,     /* a quarter of the photograph's edge or more cuts through the object */
    MERLIN_DOUBT_OBJECT_SMALL = 1 << 11,   /* the object has fewer than 2500 pixels */
    MERLIN_DOUBT_GREY = 1 << 12,           /* a black-and-white picture: albedo's colour is not to be known */
    MERLIN_DOUBT_REDUCED = 1 << 13,        /* params.shot says that it was read at a reduced size */
    MERLIN_DOUBT_FIRST_FRAME = 1 << 14,    /* params.shot says that it is an animation's first picture */
    MERLIN_DOUBT_LIGHT_BEHIND = 1 << 15,   /* most of its light, as far as the model can tell, comes from behind it */
    /* of maps that were read, which somebody has edited: by `mended` */
    MERLIN_DOUBT_NORMALS_NOT_UNIT = 1 << 16,
    MERLIN_DOUBT_ALBEDO_CLAMPED = 1 << 17,
    MERLIN_DOUBT_ROUGHNESS_CLAMPED = 1 << 18,
    MERLIN_DOUBT_DEPTH_CLAMPED = 1 << 19,
} merlin_doubt;

/* All of the photograph's size, zero where mask is zero, finite everywhere. */
typedef struct merlin_maps {
    merlin_image albedo;         /* 3, [0, 1] */
    merlin_image normal;         /* 3, unit, z > 0 toward the camera */
    merlin_image roughness;      /* 1, [0.03, 1] */
    merlin_image depth;          /* 1, distance along -z in scene units */
    merlin_image mask;           /* 1, coverage in [0, 1] */
    merlin_image photo;          /* 3, the photograph times the mask */
    merlin_image reconstruction; /* 3, the maps under the flash, or under `light` where that is known, exposed as by
                                    merlin_relight */
    struct {
        int x, y, side; /* the square of the photograph that the network saw; may hang over its edges */
    } crop;
    int size;        /* what that square was resized to, at most 256: for all but fine normals */
    float gain;      /* the photograph times this is radiance under a flash of power 5.95 */
    float burnt_out; /* share of the object's values at the photograph's white, in [0, 1]: albedo and roughness are
                      * guesses there, and from a tenth on they are poor (photograph it darker) */
    merlin_mask_source mask_source;
    int has_environment;      /* the model knows of surroundings beside the flash: */
    float environment[9][3];  /* those of the photograph as it sees them, spherical harmonics of radiance per channel */
    merlin_found_light light; /* the photograph's */
    float mask_confidence;    /* 1 for a given mask; how likely a found one is right, in [0, 1] (below 0.5: check it) */
    char model[64];
    merlin_timing timing;
    unsigned doubts;       /* merlin_doubt's bits; of maps that were read, what was mended of them alone */
    float light_elsewhere; /* how likely the photograph was lit from elsewhere than the lens, in [0, 1] */
    int reduced, frames;   /* params.shot's */
    float fov; /* how wide the crop is, degrees, by params.fov or params.shot; 0: unknown, the maps take it for 60 */
    float slant[2]; /* where the crop's middle is as seen from the lens, sines to the right and upwards; the maps' space
                     * is that of a camera that looks at it */
    struct {
        float normal, albedo, roughness, depth; /* shares of the object, in [0, 1]: normals that were not unit and were
                                                 * made so; the others out of their range, to which they were clamped */
    } mended;                                   /* zeros but of maps that were read */
} merlin_maps;

/* photo: 3 channels, at least 16 pixels a side and at most 64 million pixels. mask: 1 channel of the same size,
 * coverage in [0, 1]: what is covered by half or more is the object; NULL or without data: the object is searched for.
 * params NULL: the defaults. */
merlin_status merlin_estimate(merlin_model *model, const merlin_image *photo, const merlin_image *mask,
                              const merlin_params *params, merlin_maps *maps);
void merlin_maps_free(merlin_maps *maps);
/* A doubt's name, "light_elsewhere", as in report.json; "" for what is none. */
const char *merlin_doubt_code(merlin_doubt doubt);
/* One doubt in words for a person: a sentence about these maps, without a full stop, into text as snprintf does it. */
int merlin_doubt_message(const merlin_maps *maps, merlin_doubt doubt, char *text, int size);

/* maps.exr, the PNGs, overview.png and report.json into a folder, which is made if need be: all of them or, after a
 * failure, none. The model adds two new lights to the overview. Of maps with a reconstruction only. */
merlin_status merlin_maps_write(merlin_model *model, const merlin_maps *maps, const char *folder);
/* Reads maps.exr of such a folder, edited or not: values that are not finite, and maps that are wholly out of their
 * range or of another size than was written, are MERLIN_BAD_INPUT. The reconstruction stays without data. */
merlin_status merlin_maps_read(const char *folder, merlin_maps *maps);

/* ---- from maps to new light ---- */

typedef enum merlin_relighting {
    MERLIN_BY_BRDF, /* the maps' microfacet BRDF with cast shadows, plus the network's global illumination */
    MERLIN_BY_NETWORK, /* the relighting decoder, for lights on the frontal hemisphere: (sinθ cosφ, sinθ sinφ, cosθ - 1)
                        */
    MERLIN_BY_BRDF_UNSHADOWED, /* by the BRDF without cast shadows, as in the paper */
    MERLIN_BY_BRDF_DIRECT,     /* by the BRDF with cast shadows, without the network's global illumination */
} merlin_relighting;

/* The object under one point light at this place instead of the flash, of the flash's power (5.95): the photograph's
 * size and exposure (the usual one if its values go beyond 1), 3 channels in [0, 1]. */
merlin_status merlin_relight(merlin_model *model, const merlin_maps *maps, const float light[3], merlin_relighting how,
                             merlin_image *out);

/* Surroundings: a latitude-longitude picture, twice as wide as high (Radiance HDR or EXR; up is its top row, straight
 * ahead of the camera its middle column, right of that the camera's right). */
typedef struct merlin_environment merlin_environment;

/* Such files are in no known unit: mean luminance becomes 2^exposure, at 0 a white object about as bright as
 * under the flash. turn: degrees about the vertical; at 90 what was straight ahead is to the camera's right. */
merlin_status merlin_environment_read(const char *path, float turn, float exposure, merlin_environment **out);
void merlin_environment_free(merlin_environment *environment);

/* The object in these surroundings, and under a point light too unless that is NULL: diffuse by nine spherical
 * harmonics, highlights from the picture itself. MERLIN_BY_BRDF: with the shadows that the object casts on itself and a
 * bounce. MERLIN_BY_NETWORK needs a light and a model that was trained for both; its surroundings cast no shadows. */
merlin_status merlin_relight_environment(merlin_model *model, const merlin_maps *maps,
                                         const merlin_environment *environment, const float *light,
                                         merlin_relighting how, merlin_image *out);

/* Relights by the light that was found in the photograph (maps.light), its lamp and surroundings turned about the
 * vertical by so many degrees: at 90 what was straight ahead of the camera is to its right; a flash stays at the lens.
 * MERLIN_BAD_INPUT where the model found none; not MERLIN_BY_NETWORK. */
merlin_status merlin_relight_found(merlin_model *model, const merlin_maps *maps, float turn, merlin_relighting how,
                                   merlin_image *out);

/* Maps made ready once for many lights, which each take a fraction of the time then. */
typedef struct merlin_stage merlin_stage;

/* side: pixels a side of the pictures, which show the square `crop`; 0: as many as it has in the photograph; at most
 * 8000. The maps may be freed afterwards; the model must outlive the stage. */
merlin_status merlin_stage_new(merlin_model *model, const merlin_maps *maps, int side, merlin_relighting how,
                               merlin_stage **out);
/* The square under a point light (or NULL), in surroundings (or NULL), or both: side x side, 3 channels in [0, 1], zero
 * beside the object. One thread at a time for a stage. */
merlin_status merlin_stage_relight(merlin_stage *stage, const float *light, const merlin_environment *environment,
                                   merlin_image *out);
void merlin_stage_free(merlin_stage *stage);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
/* merlin/maps: what an object is made of, pixel by pixel; why maps may be wrong; their files.
 *
 *     merlin_maps maps;
 *     if (merlin_maps_read("cup.merlin", &maps)) fprintf(stderr, "%s\n", merlin_error());
 *     ... maps.albedo, maps.normal, ...
 *     merlin_maps_free(&maps);
 *
 * merlin/estimate.h makes them of a photograph, merlin/relight.h shows them under other light. Space: the camera is at
 * the origin and looks along -z, x right, y up; the object stands near (0, 0, -1). The square `crop` around the object
 * counts as the whole frame of a camera that looks at its centre: as wide as the photograph's lens makes it, or 60
 * degrees where that is not known. */
#ifndef MERLIN_MAPS_H
#define MERLIN_MAPS_H

#include <merlin/image.h>
#include <merlin/model.h>
#include <merlin/warnings.h>

#ifdef __cplusplus
extern "C" {
#endif

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

/* Puts it in words for a person, such as "a lamp from the upper left, 40 degrees aside, in a room", into text as
 * snprintf does; less than MERLIN_LIGHT_WORDS characters, none where nothing is known. It names what sends a seventh of
 * the light or more. */
enum { MERLIN_LIGHT_WORDS = 128 };
int merlin_light_words(const merlin_found_light *light, char *text, int size);

typedef enum merlin_mask_source { MERLIN_MASK_GIVEN, MERLIN_MASK_FOUND } merlin_mask_source;

typedef struct merlin_timing {
    double mask, prepare, choose, compile, network, upsample; /* seconds; choose: which of two models it is for */
} merlin_timing;

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
    int reduced, frames;   /* merlin_shot's */
    int captured;   /* 1: of a surface of photometric stereo, which has no gloss and no photograph: `photo` is black. It
                     * stands about (0, 0, -1), the square around it for a frame 60 degrees wide */
    float fov;      /* how wide the crop is, degrees, by what is known of the lens; 0: unknown, they take it for 60 */
    float slant[2]; /* where the crop's middle is as seen from the lens, sines to the right and upwards; the maps' space
                     * is that of a camera that looks at it */
    struct {
        float normal, albedo, roughness, depth; /* shares of the object, in [0, 1]: normals that were not unit and were
                                                 * made so; the others out of their range, to which they were clamped */
    } mended;                                   /* zeros but of maps that were read */
} merlin_maps;

void merlin_maps_free(merlin_maps *maps);

/* ---- doubts ---- */

/* Why maps may be wrong, the gravest first: each a bit of merlin_maps' doubts. A model knows one object, and most know
 * one light, a flash at the lens; of anything else they make maps, too. */
typedef enum merlin_doubt {
    MERLIN_DOUBT_NO_OBJECT = 1 << 0,       /* the object found, or the mask given, fills the photograph */
    MERLIN_DOUBT_BURNT_OUT = 1 << 1,       /* burnt_out is a tenth or more */
    MERLIN_DOUBT_OBJECT_UNSURE = 1 << 2,   /* mask_confidence is below 0.5 */
    MERLIN_DOUBT_LIGHT_ELSEWHERE = 1 << 3, /* light_elsewhere, or light if that is known, says: not by a flash alone */
    MERLIN_DOUBT_NO_FLASH = 1 << 4,        /* params.shot says that no flash fired */
    MERLIN_DOUBT_LIGHT_BEHIND = 1 << 5,    /* most of its light, as far as the model can tell, comes from behind it */
    MERLIN_DOUBT_HOLLOW = 1 << 6,          /* along the outline the normals turn inward, as of a bowl */
    MERLIN_DOUBT_DRAWING = 1 << 7,         /* most of it are areas of one colour: a drawing or a screenshot */
    MERLIN_DOUBT_LENS_NARROW = 1 << 8,     /* fov is below 5 */
    MERLIN_DOUBT_LENS_WIDE = 1 << 9,       /* fov is above 95 */
    MERLIN_DOUBT_DARK = 1 << 10,           /* too few shades: nearly black */
    MERLIN_DOUBT_OBJECT_CUT = 1 << 11,     /* a quarter of the photograph's edge or more cuts through the object */
    MERLIN_DOUBT_OBJECT_SMALL = 1 << 12,   /* the object has fewer than 2500 pixels */
    MERLIN_DOUBT_GREY = 1 << 13,           /* a black-and-white picture: albedo's colour is not to be known */
    MERLIN_DOUBT_REDUCED = 1 << 14,        /* params.shot says that it was read at a reduced size */
    MERLIN_DOUBT_FIRST_FRAME = 1 << 15,    /* params.shot says that it is an animation's first picture */
    /* of maps that were read, which somebody has edited: by `mended` */
    MERLIN_DOUBT_NORMALS_NOT_UNIT = 1 << 16,
    MERLIN_DOUBT_ALBEDO_CLAMPED = 1 << 17,
    MERLIN_DOUBT_ROUGHNESS_CLAMPED = 1 << 18,
    MERLIN_DOUBT_DEPTH_CLAMPED = 1 << 19,
} merlin_doubt;

/* Returns a doubt's name, "light_elsewhere", as in report.json; "" for what is none. */
const char *merlin_doubt_code(merlin_doubt doubt);
/* Puts one doubt in words for a person: a sentence about these maps, without a full stop, into text as snprintf does.
 */
int merlin_doubt_message(const merlin_maps *maps, merlin_doubt doubt, char *text, int size);
/* Lists all doubts of these maps, each with its code and its words. */
void merlin_maps_warnings(const merlin_maps *maps, merlin_warnings *out);

/* ---- files ---- */

/* All zeros is the usual case. */
typedef struct merlin_write_params {
    int in_place; /* 1: straight into the folder, which is there and which nobody looks into yet; after a failure some
                   * files may be left in it */
    int last; /* 1: no photograph follows, as of merlin_params: what the model lets go of now is not beside the files
               * in memory */
    int (*stop)(void); /* asked between files; returning nonzero ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* told "writing"; may be NULL */
    void *progress_context;
} merlin_write_params;

/* Writes maps.exr, the PNGs, overview.png and report.json into a folder, which is made if need be: all of them or,
 * after a failure, none. The model adds two new lights to the overview. Of maps with a reconstruction only. params
 * NULL: the usual case. */
merlin_status merlin_maps_write(merlin_model *model, const merlin_maps *maps, const merlin_write_params *params,
                                const char *folder);
/* Composes the text of report.json: what was done to a photograph, its doubts, the maps' statistics (docs/json.md has
 * the names). It is yours to give to free. */
merlin_status merlin_maps_report(const merlin_maps *maps, char **text);
/* Reads maps.exr of such a folder, or of a captured surface's, edited or not: values that are not finite, and maps that
 * are wholly out of their range or of another size than was written, are MERLIN_BAD_INPUT. The reconstruction stays
 * without data. */
merlin_status merlin_maps_read(const char *folder, merlin_maps *maps);
/* Finds which of the two these are, without reading them: *captured as in merlin_maps, 0 if they cannot be read. */
merlin_status merlin_maps_look(const char *folder, int *captured);

#ifdef __cplusplus
}
#endif

#endif

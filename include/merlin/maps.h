/* SPDX-License-Identifier: MIT */
/* merlin/maps: material and shape of an object, pixel by pixel; why maps may be wrong; their files.
 *
 *     merlin_maps maps;
 *     if (merlin_maps_read("cup.merlin", &maps)) fprintf(stderr, "%s\n", merlin_error());
 *     ... maps.albedo, maps.normal, ...
 *     merlin_maps_free(&maps);
 *
 * merlin/estimate.h makes them from a photograph, merlin/relight.h renders them under other light. Space: the camera is
 * at the origin and looks along -z, x right, y up; the object is near (0, 0, -1). The square `crop` around the object
 * counts as the whole frame of a camera that looks at its centre: as wide as the photograph's lens makes it, or 60
 * degrees if that is unknown. */
#ifndef MERLIN_MAPS_H
#define MERLIN_MAPS_H

#include <merlin/image.h>
#include <merlin/model.h>
#include <merlin/warnings.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The light of a photograph, as a model of any light estimates it; zeros for other models. Strengths are relative to
 * the photograph's radiance (its values times gain): 1 is a lamp of power 5.95 at distance 1. */
typedef struct merlin_found_light {
    int known;           /* whether the model estimates the light */
    float flash;         /* strength of a flash at the lens; 0: none */
    float lamp[3];       /* unit vector from the object's middle, (0, 0, -1), toward the strongest lamp; zeros: none */
    float lamp_sure;     /* probability that there is one, in [0, 1] */
    float lamp_distance; /* distance from there; 0: far away, its light is parallel */
    float lamp_strength[3]; /* strength in the object's middle, by channel */
    float rest[9][3];       /* all other light: spherical harmonics of radiance, bands 0 to 2 */
} merlin_found_light;

/* Describes it for a person, such as "a lamp from the upper left, 40 degrees aside, in a room", into text as snprintf
 * does; less than MERLIN_LIGHT_WORDS characters, none if no model of any light has looked. It names sources of a
 * seventh of the light or more, and says if there is none. */
enum { MERLIN_LIGHT_WORDS = 128 };
int merlin_light_words(const merlin_found_light *light, char *text, int size);

/* Describes where a lamp is as seen from the camera, such as "a lamp from the upper left, 40 degrees aside". direction:
 * toward it; text and size as above. */
int merlin_lamp_words(const float direction[3], char *text, int size);

typedef enum merlin_mask_source { MERLIN_MASK_GIVEN, MERLIN_MASK_FOUND } merlin_mask_source;

typedef struct merlin_timing {
    double mask, prepare, choose, compile, network, upsample; /* seconds; choose: to choose between two models */
} merlin_timing;

/* Maps of the photograph's size, zero where mask is zero, finite everywhere. */
typedef struct merlin_maps {
    merlin_image albedo;         /* 3 channels, [0, 1] */
    merlin_image normal;         /* 3 channels, unit, z > 0 toward the camera */
    merlin_image roughness;      /* 1 channel, [0.03, 1] */
    merlin_image depth;          /* 1 channel, distance along -z in scene units */
    merlin_image mask;           /* 1 channel, coverage in [0, 1] */
    merlin_image photo;          /* 3 channels, the photograph times the mask */
    merlin_image reconstruction; /* 3 channels, the maps under the flash, or under `light` if that is known, exposed as
                                  * by merlin_relight. No data for several photographs, and for maps that were read */
    merlin_image spread;         /* of several photographs: 1 channel, by how many degrees the normals differ with other
                                  * photographs, in [0, 90]: their standard error as far as the photographs tell it, which is
                                  * without the errors that all of them share. No data for one photograph */
    struct {
        int x, y, side; /* square of the photograph that the network saw; may extend beyond its edges */
    } crop;
    int size;        /* side to which that square was resized, at most 256: for all but fine normals */
    float gain;      /* factor from the photograph to radiance under a flash of power 5.95 */
    float burnt_out; /* share of the object's values at the photograph's white, in [0, 1]: albedo and roughness are
                      * guesses there, and from a tenth on they are inaccurate (expose less) */
    merlin_mask_source mask_source;
    int has_environment;      /* whether the model estimates an environment besides the flash: */
    float environment[9][3];  /* that of the photograph, spherical harmonics of radiance per channel */
    merlin_found_light light; /* light of the photograph */
    float mask_confidence;    /* 1 for a given mask; for a found one its confidence, in [0, 1] (below 0.5: check it) */
    char model[64];
    merlin_timing timing;
    unsigned doubts;       /* bits of merlin_doubt; for maps that were read, only corrections to them */
    float light_elsewhere; /* probability that the photograph was not lit from the lens, in [0, 1] */
    int reduced, frames;   /* as in merlin_shot */
    int captured;    /* 1: maps of a surface by photometric stereo, without gloss and photograph: `photo` is black. The
                      * surface is near (0, 0, -1), with the square around it as a frame 60 degrees wide */
    int photographs; /* number of photographs that they were made from together; 0 or 1: one */
    int refined; /* 1: photometric stereo from several photographs made the normals, and the depth agrees with these */
    float further_light[3]; /* of several photographs: unit vector toward the lamp under which a further one would tell
                             * most; zeros: unknown */
    float fov;      /* horizontal field of view of the crop in degrees, by the lens; 0: unknown, taken to be 60 */
    float slant[2]; /* direction from the lens to the crop's middle, as sines to the right and upwards; the maps' space
                     * is that of a camera that looks at it */
    struct {
        float normal, albedo, roughness, depth; /* shares of the object, in [0, 1]: normals that were made unit; values
                                                 * of the others that were clamped to their range */
    } mended;                                   /* zeros except for maps that were read */
    merlin_warnings *noticed; /* of several photographs: further warnings, about their files; NULL: none */
} merlin_maps;

void merlin_maps_free(merlin_maps *maps);

/* ---- doubts ---- */

/* Reasons why maps may be wrong, the most serious first: each is a bit of merlin_maps' doubts. A model was trained on
 * single objects, and most models on one light, a flash at the lens; for anything else they give maps, too. */
typedef enum merlin_doubt {
    MERLIN_DOUBT_NO_OBJECT = 1 << 0,       /* the object found, or the mask given, fills the photograph */
    MERLIN_DOUBT_BURNT_OUT = 1 << 1,       /* burnt_out is a tenth or more */
    MERLIN_DOUBT_OBJECT_UNSURE = 1 << 2,   /* mask_confidence is below 0.5 */
    MERLIN_DOUBT_LIGHT_ELSEWHERE = 1 << 3, /* by light_elsewhere, or light if that is known: not by a flash alone */
    MERLIN_DOUBT_NO_FLASH = 1 << 4,        /* params.shot says that no flash fired */
    MERLIN_DOUBT_LIGHT_BEHIND = 1 << 5,  /* most of its light, as far as the model can estimate, comes from behind it */
    MERLIN_DOUBT_HOLLOW = 1 << 6,        /* along the outline the normals turn inward, as in a bowl */
    MERLIN_DOUBT_DRAWING = 1 << 7,       /* most of it is areas of one colour: a drawing or a screenshot */
    MERLIN_DOUBT_LENS_NARROW = 1 << 8,   /* fov is below 5 */
    MERLIN_DOUBT_LENS_WIDE = 1 << 9,     /* fov is above 95 */
    MERLIN_DOUBT_DARK = 1 << 10,         /* too few shades: nearly black */
    MERLIN_DOUBT_OBJECT_CUT = 1 << 11,   /* the photograph's edge is 15 % or more of its outline, which is cut */
    MERLIN_DOUBT_OBJECT_SMALL = 1 << 12, /* the object has fewer than 2500 pixels */
    MERLIN_DOUBT_GREY = 1 << 13,         /* a black-and-white picture: albedo's colour is unknown */
    MERLIN_DOUBT_REDUCED = 1 << 14,      /* params.shot says that it was read at a reduced size */
    MERLIN_DOUBT_FIRST_FRAME = 1 << 15,  /* params.shot says that it is an animation's first picture */
    /* of maps that were read and had been edited: by `mended` */
    MERLIN_DOUBT_NORMALS_NOT_UNIT = 1 << 16,
    MERLIN_DOUBT_ALBEDO_CLAMPED = 1 << 17,
    MERLIN_DOUBT_ROUGHNESS_CLAMPED = 1 << 18,
    MERLIN_DOUBT_DEPTH_CLAMPED = 1 << 19,
    MERLIN_DOUBT_NOT_REFINED = 1 << 20,       /* photographs is above 1, and refined 0: shape is the network's alone */
    MERLIN_DOUBT_STRENGTHS_UNEQUAL = 1 << 21, /* refined, but the photographs' lights do not seem equally strong */
    MERLIN_DOUBT_LIGHTS_FAR = 1 << 22,        /* refined, with all lights taken to be far away as the lens is unknown */
} merlin_doubt;

/* Returns a doubt's name, "light_elsewhere", as in report.json; "" for another value. */
const char *merlin_doubt_code(merlin_doubt doubt);
/* Describes one doubt for a person: a sentence about these maps, without a full stop at its end, into text as snprintf
 * does. */
int merlin_doubt_message(const merlin_maps *maps, merlin_doubt doubt, char *text, int size);
/* Lists all doubts of these maps, each with its code and description, and what was noticed in their files. */
void merlin_maps_warnings(const merlin_maps *maps, merlin_warnings *out);

/* ---- files ---- */

/* Options; all zeros are the defaults. */
typedef struct merlin_write_params {
    int in_place; /* 1: write directly into the folder, which exists and which nobody reads yet; after a failure some
                   * files may remain in it */
    int last; /* 1: no photograph follows, as in merlin_params: the model frees what it would keep, before the files are
               * made */
    int (*stop)(void); /* called between files; a nonzero result ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* called with "writing"; may be NULL */
    void *progress_context;
} merlin_write_params;

/* Writes maps.exr, the PNGs, overview.png and report.json into a folder, which is created if necessary: all of them or,
 * after a failure, none. The model adds two new lights to the overview, and to maps that were read from a folder
 * a reconstruction. MERLIN_BAD_INPUT for values that merlin_maps_read would refuse, MERLIN_WRONG_USE for maps of a
 * captured surface. params NULL: the defaults. */
merlin_status merlin_maps_write(merlin_model *model, const merlin_maps *maps, const merlin_write_params *params,
                                const char *folder);
/* Composes the text of report.json: how a photograph was processed, its doubts, the maps' statistics (docs/json.md
 * lists the names). Release it with free. */
merlin_status merlin_maps_report(const merlin_maps *maps, char **text);
/* Reads maps.exr of such a folder, or of a captured surface's, edited or not. MERLIN_BAD_INPUT for values that are not
 * finite, and for maps that are completely out of their range or of another size than was written. The reconstruction
 * has no data. */
merlin_status merlin_maps_read(const char *folder, merlin_maps *maps);
/* Finds out which of the two these are, without reading them: *captured as in merlin_maps, 0 if they cannot be read. */
merlin_status merlin_maps_look(const char *folder, int *captured);

#ifdef __cplusplus
}
#endif

#endif

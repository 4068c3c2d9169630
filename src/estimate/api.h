/* SPDX-License-Identifier: MIT */
/* What stands behind include/merlin/merlin.h, and what its parts share. */
#ifndef MERLIN_ESTIMATE_API_H
#define MERLIN_ESTIMATE_API_H

#include "base/public.h"
#include "merlin/merlin.h"
#include "base/watch.h"
#include "estimate/files/staging.h"
#include "estimate/light/env_map.h"
#include "estimate/light/horizon.h"
#include "estimate/light/shadow.h"
#include "estimate/object/mask.h"
#include "estimate/photo/light_cues.h"
#include "estimate/photo/network.h"
#include "estimate/surface/crop.h"
#include "estimate/surface/surface.h"
#include "image/exr/exr.h"

struct merlin_model {
    network *network;
    network *flash; /* for photographs lit by a flash alone; NULL: `network` sees them, too */
};

/* flash: weights for merlin_model_add_flash, or NULL. */
status model_open_pair(const char *weights, const char *flash, merlin_model **out);

/* Returns the network that made the maps; for maps of others the flash's, which knows how light goes on between
 * surfaces where a flash's is all it is given. To relight by the decoder it is one that has it. */
network *model_network(const merlin_model *model, const merlin_maps *maps, merlin_relighting how);

/* Makes programs for photographs of this size and so many views before one is there: of a pair of networks what tells
 * the light, or where it is known to be a flash, the flash's. */
status model_prepare(merlin_model *model, const merlin_params *params);
/* Closes that of its networks which is not `kept`: no photograph follows that would want it. */
void model_keep(merlin_model *model, network *kept);

struct merlin_environment {
    env_map map;
    double negative; /* share of the file's values that were negative */
};

static inline crop_square crop_of(const merlin_maps *maps)
{
    return (crop_square){maps->crop.x, maps->crop.y, maps->crop.side};
}

/* MERLIN_WRONG_USE if the maps are not what merlin_estimate or merlin_maps_read gave. */
status maps_check(const merlin_maps *maps);

/* The maps of the crop, brought to side × side pixels, their mask 0 or 1. */
status maps_surface(const merlin_maps *maps, int side, surface *out);
/* Their albedo alone; enlarged, it may be zero beside the object. */
status maps_albedo(const merlin_maps *maps, int side, img *out);

/* Which part of a photograph is the object. */
typedef struct photo_object {
    img mask;
    mask_choice choice;
    crop_square crop;
    merlin_shot shot;   /* unknown, unless it is told */
    light_cues cues;    /* what estimate_object found of the light */
    const watch *watch; /* told of what estimate_object does; may be NULL */
    bool last;          /* no photograph follows: the network that is not chosen is closed */
    double seconds;     /* that finding it took */
} photo_object;

/* merlin_estimate in two steps, so that the object can be searched for while the model is still being read. given may
 * be NULL or empty, hint NULL; estimate_object takes the mask and the photograph over, whatever it returns, and frees
 * them as soon as it can. */
status photo_object_choose(const merlin_image *photo, const merlin_image *given, const merlin_hint *hint,
                           photo_object *out);
void photo_object_free(photo_object *object);
status estimate_object(merlin_model *model, merlin_image *photo, photo_object *object, const merlin_params *params,
                       merlin_maps *maps);

/* Maps made ready for many lights: the crop at some resolution, and as the network saw it. */
typedef struct stage {
    surface full, low;
    img low_photo;              /* radiance */
    network_look *look;         /* the network's at it, for the relighting decoder; else NULL */
    img flash;                  /* `low` under it, bounce 1 */
    shadow_caster caster;       /* empty unless shadows are cast */
    horizon horizon;            /* the same, and an environment was given */
    const env_map *environment; /* lights beside the point light, or NULL; borrowed */
    float white;                /* the radiance that becomes 1: exposure_white's, unless changed */
    merlin_relighting how;
} stage;

/* side: the square's pixels a side; 0: as many as the crop has in the photograph. */
status stage_new(network *n, const merlin_maps *maps, int side, merlin_relighting how, stage *out);
void stage_free(stage *s);
/* Another side for what follows. After a failure the stage is good for nothing but stage_free. */
status stage_resize(stage *s, const merlin_maps *maps, int side);
/* Takes the gloss away, but for what the relighting decoder paints (docs/notes/rti_domes.md says what for). */
status stage_make_matte(stage *s);
/* Measures the white, a radiance, that leaves all but a thousandth of the object's values under these lamps below 1,
 * and a white matte surface that faces one of them at the object's centre. Shadows and bounces are not looked at, so
 * that it takes a fraction of the time of a picture. Without lamps: of the stage's environment. */
status stage_meter(const stage *s, const lamp *lamps, size_t count, float *white);
/* The environment (NULL: none) that lights it from now on; another, or the same turned, may follow. */
status stage_surround(stage *s, const env_map *environment);
/* MERLIN_WRONG_USE for a way of relighting that does not exist, or that wants another lamp (NULL: none). */
status stage_check(merlin_relighting how, const lamp *light, bool environment);
/* Renders the square under so many lamps together and the stage's environment, one of all at least and as stage_check
 * wants them, bounces included: 3 channels in [0, 1] of `white`. */
status stage_relight(network *n, const stage *s, const lamp *lights, int count, img *out);

/* Where merlin_maps_write writes, and what only the command line asks of it; each but folder may be NULL. */
typedef struct maps_output {
    const char *folder;
    const char *const *inputs; /* as in staging_begin */
    int (*stop)(void);         /* asked between files */
    const watch *watch;        /* told "writing" */
    bool last;                 /* no photograph follows: the network is released before the files are written */
    /* writes other files beside the maps, or elsewhere, and adds where */
    status (*more)(const void *context, const merlin_maps *maps, maps_staging *to);
    const void *context;
    staged_files *written;
} maps_output;
status maps_write(merlin_model *model, const merlin_maps *maps, const maps_output *to);
/* report.json's text, malloc'ed; NULL if memory ran out. */
char *maps_report(const merlin_maps *maps);
status maps_write_exr(const merlin_maps *maps, const char *path);
/* Makes the attribute of maps.exr that tells, after an editor has had it, whether it still is of the size it was. */
exr_attribute maps_picture_size(int width, int height);
/* All maps of the file's size and what it holds of them; roughness and photo, unless photographed, are not looked for
 * and stay zero. MERLIN_BAD_INPUT for maps that nothing can be made of (maps_examine.h); path is for messages. After a
 * failure, too, merlin_maps_free. */
status maps_read_layers(exr_file *f, const char *path, bool photographed, merlin_maps *maps);
/* Maps as the inside promises them: half floats are not quite unit normals, and anybody may have edited the file. */
void maps_tidy(merlin_maps *maps);

#endif

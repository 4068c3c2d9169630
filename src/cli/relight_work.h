/* State that the parts of relight_output.h share. */
#ifndef MERLIN_CLI_RELIGHT_WORK_H
#define MERLIN_CLI_RELIGHT_WORK_H

#include "cli/relight_output.h"
#include "estimate/api.h"
#include "estimate/found_light.h"

typedef struct relight_work {
    const relight_job *job;
    staging *staging;
    stage stage;
    found_lights found; /* of a job's `found`; an orbit turns it */
    relight_result *result;
    size_t done; /* of relight_count_whole */
} relight_work;

/* ERROR_STOPPED if the job is to stop. */
status relight_check(const relight_work *w);
/* Tells whether surroundings go round in an orbit, and no lamp. */
bool relight_surroundings_turn(const relight_job *job);
/* Returns the lamps that shine together in picture i, and how many: the found light's, else the user's i-th, if any. */
const lamp *relight_lamps(const relight_work *w, size_t i, int *count);
/* Renders the stage's square under so many lamps together; counts what is burnt out. */
status relight_square(relight_work *w, const lamp *lights, int count, img *out);
/* Tells whether a name is kind_000.png or .jpg, or one with another number; kind: with its "_". */
bool relight_is_numbered(const char *name, const char *kind);
/* ".png" or ".jpg" */
const char *relight_ending(const relight_job *job);

/* Lamp i of a dome. */
lamp relight_dome_lamp(const relight_job *job, int i);
/* ERROR_OUTPUT where the folder has files of another dome that would be taken with these. */
status relight_dome_check(const relight_job *job);
/* Counts the numbered pictures of an earlier run that stay beside those that were written. */
void relight_find_left(const relight_job *job, relight_result *result);
status relight_write_dome(relight_work *w);
/* Lamp i of an orbit. */
lamp relight_orbit_lamp(const relight_job *job, int i);
/* frame_000.png and on, orbit.png and animations; the stage has the frames' size. */
status relight_write_orbit(relight_work *w, int side);

/* Small copies and their labels, for a sheet. */
enum { RELIGHT_MOST_TILES = 24, RELIGHT_LABEL = 48 };
typedef struct relight_sheet {
    img pictures[RELIGHT_MOST_TILES];
    char labels[RELIGHT_MOST_TILES][RELIGHT_LABEL];
    int count;
} relight_sheet;
void relight_label(const lamp *lights, int count, char label[RELIGHT_LABEL]);
/* A small copy of the square, if there is room. */
status relight_sheet_add(relight_sheet *s, const img *picture, const char *label);
status relight_sheet_write(const relight_sheet *s, const relight_work *w, const char *name);
void relight_sheet_free(relight_sheet *s);

/* A picture of the photograph's size. */
typedef struct relight_picture {
    const char *name; /* NAME_000.png or .jpg */
    size_t number;
    const lamp *lights;   /* together; */
    int count;            /* 0: the environment alone */
    relight_sheet *sheet; /* where a small copy goes, or NULL */
    bool alone;           /* as NAME.png or .jpg, too */
} relight_picture;
status relight_write(relight_work *w, const relight_picture *p);

#endif

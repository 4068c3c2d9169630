/* SPDX-License-Identifier: MIT */
/* What the readers of the capture layouts share. Each layout fills names, lights and camera; then the pictures are
 * read, and last what must have their size. On failure pst_capture_read frees what was filled. */
#ifndef MERLIN_STEREO_CAPTURE_CAPTURE_PARTS_H
#define MERLIN_STEREO_CAPTURE_CAPTURE_PARTS_H

#include "base/lights/light_list.h"
#include "stereo/capture/capture.h"

/* Refuses a folder without pictures, and says which of the folders in it has some. */
status pst_check_pictures(const char *folder);

/* Room for the pictures of a folder and their names, sorted: not masks, ambient, ground truth or what merlin itself
 * wrote there. numbered: only names that are a number. There must be as many as the file `lights` has, which may be
 * NULL. */
status pst_take_pictures(const char *folder, bool numbered, const char *lights, size_t wanted, merlin_capture *c);

/* The folder's ambient.png, .tif and so on, rather of the kind that this picture's name has; *path is NULL if there is
 * none. Free it. */
status pst_find_ambient(const char *folder, const char *picture, char **path);

/* Fills c->skipped: what of the folder is neither a picture of the capture, nor its mask or ambient picture, each of
 * which may be NULL, nor beside them by its name. */
status pst_list_skipped(const char *folder, const char *mask, const char *ambient, merlin_capture *c);

/* Finds the folder's file of the first of these names, which end in NULL, that it has, in capitals or not; *path is
 * NULL without one. Free it. */
status pst_find_named(const char *folder, const char *const *usual, char **path);
/* Finds light_intensities.txt or a file of a name like it, in the folder or beside the list of lights (NULL: there is
 * none), likewise. MERLIN_BAD_INPUT where there are two. */
status pst_find_intensities(const char *folder, const char *lights, char **path);

/* Reads what pst_find_intensities finds, if anything: one or three numbers a line, for the capture's lights or, behind
 * a picture's name, for that one's; or a light in each column. */
status pst_read_intensities(const char *folder, const char *lights, merlin_capture *c);

/* Sets the lights of a capture that has their pictures' names. */
status pst_set_lights(const char *path, const light_list *list, const merlin_capture_files *options, merlin_capture *c);
/* Reads what pst_find_intensities finds, if anything; refuses it beside a list that says the same (listed). */
status pst_read_strengths(const char *folder, const char *lights, bool listed, merlin_capture *c);
/* Reads a list of lights, and which pictures of the folder they belong to. */
status pst_read_light_list(const char *folder, const char *lights, const merlin_capture_files *options,
                           merlin_capture *c);

status pst_read_plain(const char *folder, const merlin_capture_files *options, merlin_capture *c);
status pst_read_luces(const char *folder, merlin_capture *c);
status pst_read_luces_truth(const char *folder, merlin_capture *c);
status pst_read_diligent(const char *folder, merlin_capture *c);
status pst_read_diligent_truth(const char *folder, merlin_capture *c);

/* Planes from c->name, ambient subtracted. A width and height that a layout has set already must be the pictures'. */
status pst_read_pictures(const char *folder, const merlin_capture_files *options, merlin_capture *c);
/* Of full scale: what no light brings above this is background or never lit. */
#define PST_BLACK 0.004f

/* From a file, or found. */
status pst_read_mask(const char *folder, const merlin_capture_files *options, merlin_capture *c);
/* The file asked for; else the folder's file `usual`; else its first one with this ending, and *found says how many
 * there are (0 where it did not come to that). *path is NULL if there is none. Free it. */
status pst_find_file(const char *folder, const char *asked, const char *usual, const char *ending, char **path,
                     size_t *found);
/* The mask's file: the one asked for, else the folder's (img_folder_whole_mask); *path is NULL if there is none. Free
 * it. */
status pst_find_mask(const char *folder, const char *asked, char **path);

#endif

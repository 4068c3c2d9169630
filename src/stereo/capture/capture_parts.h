/* SPDX-License-Identifier: MIT */
/* Functions shared by the readers of the capture layouts. Each layout fills names, lights and camera; then the pictures
 * are read, and last whatever must have their size. On failure pst_capture_read frees what was filled. */
#ifndef MERLIN_STEREO_CAPTURE_CAPTURE_PARTS_H
#define MERLIN_STEREO_CAPTURE_CAPTURE_PARTS_H

#include "base/lights/light_list.h"
#include "stereo/capture/capture.h"

/* Fails for a folder without pictures, and names the subfolder that has some. */
status pst_check_pictures(const char *folder, const merlin_capture_files *options);

/* Allocates the pictures of a folder, with their names sorted: without masks, ambient picture, ground truth, merlin's
 * own output, and what the options name as mask or ambient picture. numbered: only names that are a number. Fails
 * unless there are as many as the file `lights` (which may be NULL) lists. */
status pst_take_pictures(const char *folder, bool numbered, const merlin_capture_files *options, const char *lights,
                         size_t wanted, merlin_capture *c);

/* Finds the folder's ambient.png, .tif and so on, preferably with the extension of this picture; *path is NULL if there
 * is none. Free it. */
status pst_find_ambient(const char *folder, const char *picture, char **path);

/* Fills c->skipped: files of the folder that are neither pictures of the capture, nor its mask or ambient picture (each
 * may be NULL), nor known by their names to belong to them. */
status pst_list_skipped(const char *folder, const char *mask, const char *ambient, merlin_capture *c);

/* Sets the lights of a capture that has their pictures' names. */
status pst_set_lights(const char *path, const light_list *list, const merlin_capture_files *options, merlin_capture *c);
/* Reads what light_strengths_find finds, if anything: one or three numbers per line, for the capture's lights or, after
 * a picture's name, for that one's; or a light in each column. */
status pst_read_strengths(const char *folder, const char *lights, bool listed, merlin_capture *c);
/* Reads a list of lights, and assigns them to the folder's pictures. */
status pst_read_light_list(const char *folder, const char *lights, const merlin_capture_files *options,
                           merlin_capture *c);

/* Reads those frames of a video whose light differs most, with unknown lights and the mask. */
status pst_read_video(const char *path, const merlin_capture_files *options, merlin_capture *c);

status pst_read_plain(const char *folder, const merlin_capture_files *options, merlin_capture *c);
status pst_read_luces(const char *folder, const merlin_capture_files *options, merlin_capture *c);
status pst_read_luces_truth(const char *folder, merlin_capture *c);
status pst_read_diligent(const char *folder, const merlin_capture_files *options, merlin_capture *c);
status pst_read_diligent_truth(const char *folder, merlin_capture *c);

/* Reads the pictures named in c->name, in this folder or, if that is NULL, anywhere, and subtracts the ambient one. If
 * a layout has set a width and height, the pictures must have them. */
status pst_read_pictures(const char *folder, const merlin_capture_files *options, merlin_capture *c);
/* Share of full scale that the brightest of floats becomes where it is scaled: below what solvers regard as saturated.
 */
#define PST_FLOAT_CEILING 0.97f

/* Share of full scale: pixels that no light raises above it are background, or never lit. */
#define PST_BLACK 0.004f

/* Reads the mask from this file, far from which pictures become black, or finds it if that is NULL; from: the folder or
 * video of the pictures. */
status pst_take_mask(const char *path, const char *from, merlin_capture *c);
/* Reads the folder's mask, or finds it; then lists the files that were skipped. */
status pst_read_mask(const char *folder, const merlin_capture_files *options, merlin_capture *c);
/* Finds a file: the one requested; else `usual` in the folder; else its first one with this ending, and then *found is
 * the number of these (otherwise 0). *path is NULL if there is none. Free it. */
status pst_find_file(const char *folder, const char *asked, const char *usual, const char *ending, char **path,
                     size_t *found);
/* Finds the mask's file: the one requested, else the folder's (img_folder_whole_mask); *path is NULL if there is none.
 * Free it. */
status pst_find_mask(const char *folder, const char *asked, char **path);

#endif

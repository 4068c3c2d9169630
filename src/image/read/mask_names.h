/* SPDX-License-Identifier: MIT */
/* Matches masks to photographs by the names that people and programs give to masks. Of a photograph cup.jpg it is
 *
 *     cup.mask.png, cup_mask.png, cup-mask.png, "cup mask.png", cupmask.png, mask_cup.png, cup_mask_1.png
 *
 * with any picture's extension, in any case, with matte, alpha, silhouette, segmentation, seg or label instead of mask,
 * and with cup.jpg instead of cup; in a folder of masks cup.png and cup.jpg.png, too. mask.png is for a whole folder.
 */
#ifndef MERLIN_IMAGE_READ_MASK_NAMES_H
#define MERLIN_IMAGE_READ_MASK_NAMES_H

#include <stdbool.h>
#include <stddef.h>

/* Returns how well a name fits as the mask of a photograph: 1 is best, more is worse, 0 not at all. Names are without
 * folders. apart: it lies in a folder of masks. */
int mask_name_rank(const char *name, const char *photo, bool apart);
/* Tells whether a name is that of a whole folder's mask: mask.png. */
bool mask_name_is_whole(const char *name);
/* Tells whether a name can only be a mask's, whatever lies beside it: cup.mask.png. */
bool mask_name_is_sure(const char *name);
/* Tells whether a name contains a word for a mask that may also be what a photograph shows: cup_mask.png,
 * carnival-mask.jpg, mask1.png. */
bool mask_name_is_likely(const char *name);
/* Tells whether a name contains any word for a mask, which all of the above need, except in a folder of masks. */
bool mask_name_has_word(const char *name);
/* Lists the names that are looked for, for a message. */
void mask_names_list(const char *photo, bool apart, char *words, size_t size);

#endif

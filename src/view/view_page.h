/* SPDX-License-Identifier: MIT */
/* The page without maps, made from web/ when it is built (cmake/page.awk): one string per line, up to NULL. The data of
 * the maps are written between its two parts. */
#ifndef MERLIN_VIEW_VIEW_PAGE_H
#define MERLIN_VIEW_VIEW_PAGE_H

extern const char *const view_page_head[], *const view_page_tail[];

#endif

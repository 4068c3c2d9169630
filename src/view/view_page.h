/* SPDX-License-Identifier: MIT */
/* The page without maps, made of web/ when it is built (cmake/page.awk): a line each, up to NULL. What is known of the
 * maps goes between the two. */
#ifndef MERLIN_VIEW_VIEW_PAGE_H
#define MERLIN_VIEW_VIEW_PAGE_H

extern const char *const view_page_head[], *const view_page_tail[];

#endif

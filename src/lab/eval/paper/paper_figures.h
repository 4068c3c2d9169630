/* SPDX-License-Identifier: MIT */
/* The paper's own figures, of the data of Li et al. 2018. */
#ifndef MERLIN_LAB_EVAL_PAPER_PAPER_FIGURES_H
#define MERLIN_LAB_EVAL_PAPER_PAPER_FIGURES_H

typedef enum paper_which { PAPER_TABLE1, PAPER_TABLE2 } paper_which;

/* The columns of both tables; errors mean squared, similarities SSIM. Relighting: against the true maps rendered under
 * the target light. */
enum { PAPER_ALBEDO, PAPER_ROUGHNESS, PAPER_NORMAL, PAPER_DEPTH, PAPER_NETWORK, PAPER_BRDF, PAPER_COLUMNS };

/* Returns the paper's figures of the row of a model, in its own units (errors times 100; NAN: none), or NULL. label
 * (may be NULL) receives what the table calls it. */
const double *paper_figures_of(paper_which which, const char *model, const char **label);

#endif

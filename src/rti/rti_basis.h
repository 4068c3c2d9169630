/* SPDX-License-Identifier: MIT */
/* The functions of a light's direction that a pixel's values are sums of, as viewers evaluate them. */
#ifndef MERLIN_RTI_RTI_BASIS_H
#define MERLIN_RTI_RTI_BASIS_H

#include "merlin/rti.h"

enum { RTI_MOST_TERMS = 9 };

/* Returns the word of a basis in info.json. */
const char *rti_basis_name(merlin_rti_basis basis);
/* Returns how many terms there are; 0: RBF, which has none of its own. */
int rti_term_count(merlin_rti_basis basis);
/* Computes them for a unit direction: of PTM and LRGB 1, x, y, x², xy, y²; of HSH degrees 0 to 2. */
void rti_terms(merlin_rti_basis basis, const float direction[3], double terms[RTI_MOST_TERMS]);

#endif

/* SPDX-License-Identifier: MIT */
#include "lab/eval/paper/paper_figures.h"

#include <math.h>
#include <string.h>

typedef struct published {
    const char *model, *label; /* model NULL: any other */
    double figures[PAPER_COLUMNS];
} published;

/* Label: whether the input has indirect light (g) or not (d), number of decoders, feature sharing, gated attention,
 * relighting by network or BRDF, global illumination. */
static const published table1[] = {
    {"table1-1", "1  g 1 --  --  net  --", {6.154, 18.071, 4.681, 1.958, 0.697, 0.719}},
    {"table1-2", "2  g 1 FS  --  net  --", {5.943, 17.156, 4.617, 1.932, 0.682, 0.724}},
    {"table1-3", "3  g 1 --  GA  net  --", {5.519, 15.277, 3.975, 1.751, 0.701, 0.757}},
    {"table1-4", "4  g 1 --  --  net  GI", {5.614, 14.485, 3.887, 1.713, 0.746, 0.789}},
    {"table1-5", "5  g 1 --  GA  BRDF GI", {4.723, 11.277, 3.925, 1.632, NAN, 0.844}},
    {"table1-6", "6  d 1 FS  GA  net  --", {4.517, 10.113, 3.872, 1.509, 0.764, 0.793}},
    {"table1-7", "7  g 1 FS  GA  net  --", {4.162, 9.681, 3.406, 1.462, 0.798, 0.859}},
    {"table1-8", "8  g 4 FS  GA  net  GI", {3.781, 8.891, 3.325, 1.012, 0.827, 0.892}},
    {"table1-9", "9  g 1 FS  GA  net  GI", {3.787, 8.267, 3.311, 0.975, 0.819, 0.894}},
};

/* The paper prints one column of relighting here: MERLiN's and Li's are by BRDF, Sang's is by its network. */
static const published table2[] = {
    {"li", "Li et al. 2018", {4.868, 19.431, 3.822, 1.505, NAN, 0.884}},
    {"sang", "Sang, Chandraker 2020", {3.856, 12.781, 3.459, 1.471, 0.872, NAN}},
    {NULL, "MERLiN", {3.787, 8.267, 3.311, 0.975, 0.819, 0.894}},
};

const double *paper_figures_of(paper_which which, const char *model, const char **label)
{
    const published *all = which == PAPER_TABLE1 ? table1 : table2;
    const size_t count = which == PAPER_TABLE1 ? sizeof table1 / sizeof *table1 : sizeof table2 / sizeof *table2;
    for (size_t i = 0; i < count; i++) {
        if (all[i].model && strcmp(all[i].model, model) != 0) continue;
        if (label) *label = all[i].label;
        return all[i].figures;
    }
    return NULL;
}

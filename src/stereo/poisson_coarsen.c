#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/poisson_level.h"

/* Nodes of a block of 2 × 2 that belong to one piece become one; pieces that only lie side by side stay apart, or no
 * coarse correction could give each its own slope. */
typedef struct merging {
    int *piece;  /* of each fine node, -1: of one that lies in a single block and is done with */
    int *newest; /* of each block, the coarse node made last; -1: none yet */
    int *before; /* of each coarse node, the one made before it in its block; then its number */
    int *of;     /* of each coarse node, its piece */
    int width;   /* in blocks */
} merging;

static int block_of(const merging *m, const poisson_grid *fine, int i)
{
    return fine->pixel[i] / fine->width / 2 * m->width + fine->pixel[i] % fine->width / 2;
}

/* What lies in one block has nothing left to tell a coarser grid, so that all of it may share a node there. */
static status tell_apart(const merging *m, const poisson_grid *fine)
{
    int pieces;
    status s = poisson_pieces(fine, m->piece, &pieces);
    if (s != OK) return s;
    bool *crosses = calloc((size_t)pieces, sizeof *crosses);
    if (!crosses) return fail(ERROR_MEMORY, "no memory to integrate %d pixels", fine->count);
    for (int i = 0; i < fine->count; i++)
        for (int k = 0; k < 2; k++) {
            int next = fine->next[k][i];
            if (next >= 0 && block_of(m, fine, i) != block_of(m, fine, next)) crosses[m->piece[i]] = true;
        }
    for (int i = 0; i < fine->count; i++)
        if (!crosses[m->piece[i]]) m->piece[i] = -1;
    free(crosses);
    return OK;
}

static int parent_of(const merging *m, int block, int piece, int *count)
{
    int node = m->newest[block];
    while (node >= 0 && m->of[node] != piece)
        node = m->before[node];
    if (node >= 0) return node;
    node = (*count)++;
    m->of[node] = piece;
    m->before[node] = m->newest[block];
    m->newest[block] = node;
    return node;
}

/* Parents, numbered row by row as a grid's nodes are. */
static int merge(const merging *m, const poisson_grid *fine, size_t blocks, int *parent)
{
    int count = 0, number = 0;
    memset(m->newest, 0xff, blocks * sizeof *m->newest);
    for (int i = 0; i < fine->count; i++)
        parent[i] = parent_of(m, block_of(m, fine, i), m->piece[i], &count);
    for (size_t b = 0; b < blocks; b++)
        for (int node = m->newest[b], other; node >= 0; node = other) {
            other = m->before[node];
            m->before[node] = number++;
        }
    for (int i = 0; i < fine->count; i++)
        parent[i] = m->before[parent[i]];
    return count;
}

/* Nodes of one piece in neighbouring blocks are neighbours if any of their children are, so each has one at most. */
static void link_parents(const merging *m, const poisson_grid *fine, const int *parent, poisson_grid *coarse)
{
    size_t bytes = (size_t)coarse->count * sizeof(int);
    for (int k = 0; k < 2; k++) {
        memset(coarse->next[k], 0xff, bytes);
        memset(coarse->previous[k], 0xff, bytes);
        memset(coarse->weight[k], 0, (size_t)coarse->count * sizeof *coarse->weight[k]);
    }
    for (int i = 0; i < fine->count; i++) {
        coarse->pixel[parent[i]] = block_of(m, fine, i);
        for (int k = 0; k < 2; k++) {
            int next = fine->next[k][i];
            if (next < 0 || parent[next] == parent[i]) continue;
            coarse->next[k][parent[i]] = parent[next];
            coarse->previous[k][parent[next]] = parent[i];
        }
    }
}

status poisson_grid_coarsen(const poisson_grid *fine, int *parent, poisson_grid *coarse)
{
    *coarse = (poisson_grid){.width = (fine->width + 1) / 2, .height = (fine->height + 1) / 2};
    size_t n = (size_t)fine->count, blocks = (size_t)coarse->width * (size_t)coarse->height;
    merging m = {malloc(n * sizeof(int)), malloc(blocks * sizeof(int)), malloc(n * sizeof(int)),
                 malloc(n * sizeof(int)), coarse->width};
    status s = m.piece && m.newest && m.before && m.of
                   ? tell_apart(&m, fine)
                   : fail(ERROR_MEMORY, "no memory to integrate %d pixels", fine->count);
    if (s == OK) {
        coarse->count = merge(&m, fine, blocks, parent);
        s = poisson_grid_allocate(coarse);
    }
    if (s == OK) link_parents(&m, fine, parent, coarse);
    free(m.piece);
    free(m.newest);
    free(m.before);
    free(m.of);
    return s;
}

/* SPDX-License-Identifier: MIT */
/* Processes that compute together, on one machine or many: each of them is a rank.
 *
 *     ranks *together;                             NULL where a process computes alone
 *     status s = ranks_open_mpi(&together);        under mpirun or srun
 *     if (s == OK) s = ranks_sum(together, sums, count);
 *     ranks_close(together);
 *
 * All ranks call the same functions in the same order, as each call waits for the other ranks. Sums are taken in the
 * order of the ranks, so that every rank and every run gets the same bits (docs/notes/ranks.md). */
#ifndef MERLIN_BASE_RANKS_RANKS_H
#define MERLIN_BASE_RANKS_RANKS_H

#include <stddef.h>

#include "base/status.h"

/* The transport between ranks. A connection that breaks ends the process. */
typedef struct ranks {
    int count, index; /* number of ranks, and this one's index, 0 to count - 1 */
    /* Collects every rank's bytes, one after the other, in all ranks. */
    void (*all_gather)(const void *mine, void *all, size_t bytes);
    /* Sends the k-th of `count` pieces to rank k; from receives what each rank sent here. */
    void (*all_to_all)(const void *to, void *from, size_t bytes);
    /* Copies what rank 0 has to all ranks. */
    void (*broadcast)(void *what, size_t bytes);
    void (*close)(void);
    void (*abort_all)(void); /* ends every rank with exit status 1; does not return */
} ranks;

/* Loads the plug-in merlin_mpi.so, from beside the program or where it was installed, and starts MPI.
 * MERLIN_DEVICE_FAILED if it is missing, as in builds without MPI. */
status ranks_open_mpi(ranks **out);
/* Ends the communication, after the last call of all ranks. */
void ranks_close(ranks *r);
/* Ends every rank when this one cannot go on, as the others would wait for it forever. Does nothing for NULL. */
void ranks_abort(ranks *r);

int ranks_count(const ranks *r);
int ranks_index(const ranks *r);

/* Replaces values[i] by its sum over all ranks. MERLIN_NO_MEMORY. */
status ranks_sum(const ranks *r, double *values, size_t count);
/* Sums as ranks_sum does, for many values: in double, rounded once; each rank adds up its share of the pieces.
 * MERLIN_NO_MEMORY. */
status ranks_sum_floats(const ranks *r, float *values, size_t count);
/* Copies what rank 0 has to all ranks. */
void ranks_broadcast(const ranks *r, void *what, size_t bytes);

/* Combines the results of something that each rank did by itself: OK if all have succeeded. The first rank that failed
 * gets its own status back, the others STATUS_ELSEWHERE. */
status ranks_agree(const ranks *r, status s);

#endif

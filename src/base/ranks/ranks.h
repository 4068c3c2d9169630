/* SPDX-License-Identifier: MIT */
/* Processes that compute one thing together, on one machine or many: each of them is a rank.
 *
 *     ranks *together;                             NULL wherever there is one process alone
 *     status s = ranks_open_mpi(&together);        under mpirun or srun
 *     if (s == OK) s = ranks_sum(together, sums, count);
 *     ranks_close(together);
 *
 * All ranks call the same functions in the same order, as they wait for each other in all of them. Sums are taken in
 * the order of the ranks, whoever comes first, so that every rank has the same bits and every run, too
 * (docs/notes/ranks.md). */
#ifndef MERLIN_BASE_RANKS_RANKS_H
#define MERLIN_BASE_RANKS_RANKS_H

#include <stddef.h>

#include "base/status.h"

/* How they speak to each other. A link that breaks ends the process. */
typedef struct ranks {
    int count, index; /* this one's: 0 to count - 1 */
    /* Every rank's bytes, one after the other. */
    void (*gather)(const void *mine, void *all, size_t bytes);
    /* The k-th of `count` pieces goes to rank k; from has what each rank sent here. */
    void (*exchange)(const void *to, void *from, size_t bytes);
    /* What rank 0 has, to all. */
    void (*share)(void *what, size_t bytes);
    void (*close)(void);
    void (*abandon)(void); /* ends every rank with exit status 1; does not return */
} ranks;

/* By the plug-in merlin_mpi.so beside the program or where it was installed. MERLIN_DEVICE_FAILED where it is missing,
 * which it is where merlin was built without MPI. */
status ranks_open_mpi(ranks **out);
/* Behind the last call of all ranks. */
void ranks_close(ranks *r);
/* Ends every rank where this one cannot go on, for those would wait for it for ever. Does nothing for NULL. */
void ranks_abandon(ranks *r);

int ranks_count(const ranks *r);
int ranks_index(const ranks *r);

/* values[i] becomes the sum of every rank's. MERLIN_NO_MEMORY. */
status ranks_sum(const ranks *r, double *values, size_t count);
/* The same of many: in double, rounded once; in pieces, of which every rank adds up its share. MERLIN_NO_MEMORY. */
status ranks_sum_floats(const ranks *r, float *values, size_t count);
/* What rank 0 has, to all. */
void ranks_share(const ranks *r, void *what, size_t bytes);

/* What came of something that every rank did by itself: OK where all have succeeded. The first that failed hears what
 * it said, the others STATUS_ELSEWHERE. */
status ranks_agree(const ranks *r, status s);

#endif

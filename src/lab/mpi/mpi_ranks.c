/* SPDX-License-Identifier: MIT */
/* merlin_mpi.so: ranks that communicate by MPI (base/ranks/ranks.h), loaded only on request. */
#include <limits.h>
#include <mpi.h>

#include "base/ranks/ranks.h"

ranks *merlin_ranks_begin(void);

static void all_gather(const void *mine, void *all, size_t bytes)
{
    MPI_Allgather(mine, (int)bytes, MPI_BYTE, all, (int)bytes, MPI_BYTE, MPI_COMM_WORLD);
}

static void all_to_all(const void *to, void *from, size_t bytes)
{
    MPI_Alltoall(to, (int)bytes, MPI_BYTE, from, (int)bytes, MPI_BYTE, MPI_COMM_WORLD);
}

/* Copies in parts, as MPI counts in int. */
static void broadcast(void *what, size_t bytes)
{
    for (char *p = what; bytes > 0;) {
        int part = bytes < INT_MAX ? (int)bytes : INT_MAX;
        MPI_Bcast(p, part, MPI_BYTE, 0, MPI_COMM_WORLD);
        p += part;
        bytes -= (size_t)part;
    }
}

static void end(void)
{
    MPI_Finalize();
}

static void abort_all(void)
{
    MPI_Abort(MPI_COMM_WORLD, 1);
}

/* Starts MPI and returns the transport. Errors are fatal by MPI's default: a rank that has lost another one cannot
 * continue. */
ranks *merlin_ranks_begin(void)
{
    static ranks all = {.all_gather = all_gather,
                        .all_to_all = all_to_all,
                        .broadcast = broadcast,
                        .close = end,
                        .abort_all = abort_all};
    int given;
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &given) != MPI_SUCCESS) return NULL;
    MPI_Comm_size(MPI_COMM_WORLD, &all.count);
    MPI_Comm_rank(MPI_COMM_WORLD, &all.index);
    return &all;
}

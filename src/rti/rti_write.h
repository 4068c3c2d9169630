/* SPDX-License-Identifier: MIT */
/* The files of relit pictures: relight's info.json, and RTIViewer's .ptm. */
#ifndef MERLIN_RTI_RTI_WRITE_H
#define MERLIN_RTI_RTI_WRITE_H

#include "rti/rti_components.h"
#include "rti/rti_planes.h"
#include "rti/rti_sums.h"

/* Writes info.json; components: those of RBF, else NULL. */
status rti_write_info(const char *path, const merlin_rti *rti, const rti_planes *planes,
                      const rti_components *components);
/* Writes a .ptm of PTM, whose planes are shared, or LRGB. */
status rti_write_ptm(const char *path, const rti_planes *planes);

#endif

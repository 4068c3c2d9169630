/* What both ways of integrating share: the step from a pixel to its neighbour that a normal asks for. Internal.
 *
 * The unknown x is depth in pixels (orthographic) or the logarithm of depth (perspective; Quéau, Durou & Aujol 2018,
 * "Normal integration: a survey"). A surface point is d r with the pixel's ray r = ((u − cx)/f, −(v − cy)/f, −1). The
 * chord to the neighbour's point d' r' is perpendicular to some m:  d'/d = (m·r)/(m·r'). */
#ifndef MERLIN_STEREO_INTEGRATE_STEPS_H
#define MERLIN_STEREO_INTEGRATE_STEPS_H

#include "stereo/integrate.h"
#include "stereo/poisson.h"

/* Slopes steeper than 1/this, about 87 degrees, are taken as that. */
#define STEPS_GRAZING ((real)0.05)
/* What keeps a pair from falling apart when nothing is known of it. */
#define STEPS_LEAST_WEIGHT 1e-6f

typedef struct integration_steps {
    const img *normal;
    pst_camera camera;
    poisson_grid grid;
} integration_steps;

/* The normal at a node; zero if there is none or it is not finite. */
vec3 steps_normal(const integration_steps *s, int node);
/* cos of the angle between m and the line of sight at a node, at least STEPS_GRAZING; times the ray's length. */
real steps_facing(const integration_steps *s, int node, vec3 m);
/* x[to] − x[from] for `to` the next of `from` in the direction, along a chord perpendicular to m (not zero). */
real steps_between(const integration_steps *s, int direction, int to, vec3 m);

/* Sets weights and targets for least squares. */
void steps_least_squares(integration_steps *s);
/* Bilaterally weighted least squares (Cao et al., ECCV 2022, "Bilateral normal integration") from least squares' x: one
 * solution after another, each side of a pixel weighed by how well the other fits. stepped: x has its steps already. */
status integrate_edges(integration_steps *s, poisson_solver *solver, bool stepped, double *x);

#endif

/* SPDX-License-Identifier: MIT */
/* merlin/surface: files and maps of a surface from photometric stereo, and photometric stereo from one photograph.
 *
 *     merlin_maps maps;
 *     if (merlin_surface_write(&surface, "owl", NULL, "owl-surface") || merlin_maps_from_surface(&surface, &maps))
 *         fprintf(stderr, "%s\n", merlin_error());
 *     ... merlin_relight(model, &maps, ...), merlin_view_write(&maps, ...) ...
 *
 * merlin/stereo.h computes surfaces, merlin/mesh.h makes triangles of them. */
#ifndef MERLIN_SURFACE_H
#define MERLIN_SURFACE_H

#include <merlin/estimate.h>
#include <merlin/stereo.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Writes maps.exr, normal.png (16 bits), albedo.png, depth.png, mask.png, error.png, overview.png and report.json into
 * a folder, which is created if necessary: all of them or, after a failure, none. Albedo is scaled so that its
 * brightest values are 0.9. input: name of what the surface was made from, for the report; NULL: left out. params NULL:
 * the usual case. */
merlin_status merlin_surface_write(const merlin_surface *surface, const char *input, const merlin_write_params *params,
                                   const char *folder);
/* Composes the text of report.json: method, pictures, residual, estimated lights, warnings (docs/json.md lists the
 * names). Give it to free. */
merlin_status merlin_surface_report(const merlin_surface *surface, const char *input, char **text);

/* Makes maps of a surface, as merlin_maps_read does of its folder, so that it can be relit. The surface is moved in
 * front of a photograph's camera, to (0, 0, -1), and keeps the ratio of its relief to its width; normals stay as they
 * are. It is matte, as gloss was not measured. MERLIN_BAD_INPUT if the depths of a near camera are not positive. */
merlin_status merlin_maps_from_surface(const merlin_surface *surface, merlin_maps *out);

/* ---- from one photograph ---- */

/* Limit in degrees: normals with a larger spread are replaced by those of the photograph's maps. */
enum { MERLIN_SPREAD_LIMIT = 20 };

/* Computes a surface from the maps of one photograph. They are relit under 50 near lights of the frontal hemisphere,
 * and five random subsets of 32 of these pictures are solved, by MERLIN_STEREO_NEAR or _UNCALIBRATED, with a fixed
 * seed. The surface is the square around the object, of at most 512 pixels per side: the mean of the normals, their
 * spread as residual, the photograph's albedo. surface.relit contains figures, surface.warnings the photograph's
 * warnings. Progress: "solving", then "integrating". params NULL: the usual case; iterations, integrate and unchecked
 * are ignored. */
merlin_status merlin_stereo_from_maps(merlin_model *model, const merlin_maps *maps, const merlin_stereo_params *params,
                                      merlin_surface *out);

/* ---- from several photographs ---- */

/* Makes maps of the object of a capture from its pictures alone, of one or more of them: its lights may be unknown, and
 * are ignored. The model is one of any light, and sees up to 32 of them; from 7 pictures on
 * photometric stereo refines its normals where that explains the pictures by a similar surface (maps.refined). Where
 * the capture's field of view is known and its lights turn out to be near, params->near_network makes that better from
 * 3 pictures on. The capture's mask is the object; without one it is searched for in all pictures. photo and light are
 * those of the first picture. params NULL: the defaults; flash is ignored. */
merlin_status merlin_maps_from_capture(merlin_model *model, const merlin_capture *capture, const merlin_params *params,
                                       merlin_maps *maps);

#ifdef __cplusplus
}
#endif

#endif

/* SPDX-License-Identifier: MIT */
#include "cli/relight/relight_help.h"

#include <stdio.h>

static const char help[] =
    "usage: merlin relight PHOTO|DIR --light x,y,z [--light ...] [options]\n"
    "       merlin relight PHOTO|DIR --direction x,y,z [options]\n"
    "       merlin relight PHOTO|DIR --lights FILE [options]\n"
    "       merlin relight PHOTO|DIR --orbit N [options]\n"
    "       merlin relight PHOTO|DIR --dome N [--lp | --rti TYPE] [options]\n"
    "       merlin relight PHOTO|DIR --env FILE [--rotate DEG] [--light x,y,z] [--orbit N] [options]\n"
    "       merlin relight PHOTO|DIR --found-light [--rotate DEG] [--orbit N] [options]\n\n"
    "Shows an object under a lamp, an environment, or both instead of the flash. DIR is a folder made by\n"
    "merlin estimate or merlin stereo (whose surfaces have no gloss), or its maps.exr, or a sequence's, whose frames\n"
    "have one light (with --orbit one that goes round in N frames); a PHOTO (or -, which is standard input and wants\n"
    "-o) is estimated first.\n"
    "The camera is at 0,0,0 and looks along -z, x right, y up; the object is near 0,0,-1; the crop around the object\n"
    "counts as a frame 60 degrees wide.\n\n";

/* separate, since compilers need not accept strings of more than 4095 characters */
static const char help_on_lights[] =
    "      --light x,y,z    a lamp's place; may be given again, for another picture\n"
    "      --direction x,y,z\n"
    "                       a lamp far away, toward which x,y,z points; as bright as one at distance 1; likewise\n"
    "      --lights FILE    lamps from a file: places, x y z a line, or the directions of an .lp file (far away, but\n"
    "                       with --near)\n"
    "      --together       these lamps in one picture, instead of a picture each\n"
    "      --orbit N        N frames (2 to 240) with the lamp on a circle in front of the object, also as orbit.webp\n"
    "                       and orbit.gif\n"
    "      --dome N         N pictures (3 to 999), dome_000.png and on, under far lights spread evenly over the "
    "frontal\n"
    "                       hemisphere, for RTI tools and merlin stereo, and mask.webp; all of one exposure\n"
    "      --lp             with --dome: dome.lp, the light list of RTI tools and of merlin stereo; that of an\n"
    "                       earlier dome in the same folder is renewed without it, too\n"
    "      --rti TYPE       with --dome: instead of the pictures one that viewers on the web relight, info.json and\n"
    "                       plane_0.jpg and on for OpenLIME and relight: ptm (polynomials), hsh (harmonics), rbf\n"
    "                       (interpolation), or lrgb (polynomials of brightness, for relight alone); of ptm and lrgb\n"
    "                       with -o FILE.ptm that file, for RTIViewer\n"
    "      --near           the dome's lamps stand beside the object, and lights.txt lists their places, x y z from\n"
    "                       the camera, as merlin stereo --near reads them\n"
    "      --radius R       with --near: how far from 0,0,-1 (default 1)\n"
    "      --power P        lamps P times as strong (default 1); behind a --light or --direction this one alone,\n"
    "                       before the first all that have no power of their own; the same holds of\n"
    "      --color C        linear r,g,b, or #rrggbb as in sRGB, or a temperature such as 2700K\n"
    "      --exposure EV|auto\n"
    "                       brighter by EV stops than the photograph, or than a lamp at distance 1 makes a white "
    "matte\n"
    "                       surface white; auto: what is brightest just stays below white, as do white matte\n"
    "                       surfaces (default: auto for --dome, and for a surface of merlin stereo; else 0)\n"
    "      --format F       png (default) or jpg, of high quality, for pictures of the photograph's size\n"
    "      --env FILE       surroundings from a latitude-longitude picture (.hdr, .exr; in others no\n"
    "                       lamp or sky is brighter than white), alone or beside each lamp; with --orbit they go\n"
    "                       round once, and the lamp stays\n"
    "      --found-light    the light that a model of any light found in the photograph, put back or turned: with\n"
    "                       --rotate, or once round with --orbit; its flash stays at the lens\n"
    "      --rotate DEG     turns them about the vertical: at 90 what was straight ahead is to the right\n"
    "      --env-exposure EV\n"
    "                       makes them brighter or darker by EV stops (default 0: mean luminance 1)\n";

static const char help_on_options[] =
    "      --by WAY         brdf (default): the maps' BRDF with cast shadows and the network's global illumination;\n"
    "                       network: the relighting decoder, for lamps 0.5 to 2 away from 0,0,-1 with z >= -1\n"
    "      --no-shadows     brdf without cast shadows (lamps and surroundings), as in the paper\n"
    "      --no-bounces     brdf with cast shadows, but without the network's global illumination\n"
    "      --matte          brdf without gloss: what least squares, as of RTI tools, finds normals in\n"
    "  -o, --output DIR     where to (default: relit, or rti with --rti, inside DIR, or inside the photograph's name "
    "+\n"
    "                       .merlin); - writes one picture to standard output\n"
    "      --frame N        side of the orbit's frames (default: the crop's, at most 512)\n"
    "      --mask FILE, --point X,Y, --box X,Y,W,H, --size N, --views N\n"
    "                       for a PHOTO, as in merlin estimate\n"
    "      --photo-exposure EV|auto\n"
    "                       for a PHOTO, --exposure of merlin estimate\n"
    "      --model W        weights: merlin-any (any light), merlin-point (flash alone), merlin-env (flash in a "
    "room),\n"
    "                       or a file (default: $MERLIN_MODEL, else merlin-any, and merlin-point for photographs\n"
    "                       that it sees lit by a flash alone; for a DIR the weights of its maps)\n"
    "      --json           a report as JSON on standard output\n"
    "  -t, --threads N      how many threads work (default: one a processor)\n"
    "  -q, --quiet          no other output than errors\n"
    "  -h, --help           this text\n\n";

static const char help_on_files[] =
    "Writes relit_000.png and on, and relit.png: of one light the picture itself, of several a sheet with all of "
    "them;\n"
    "for an orbit frame_000.png and on, and orbit.png; for a sequence its frames, frame_0001.png and on, and relit.mp4 "
    "if\n"
    "FFmpeg's libraries are there.\n";

void relight_print_help(void)
{
    fputs(help, stdout);
    fputs(help_on_lights, stdout);
    fputs(help_on_options, stdout);
    fputs(help_on_files, stdout);
}

/* SPDX-License-Identifier: MIT */
#include "merlin/calibrate.h"

#include <math.h>
#include <stdio.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/lights/light_list.h"
#include "base/staging.h"
#include "image/image.h"
#include "image/resize.h"
#include "image/write/canvas.h"

static void print_lights(FILE *out, const void *context)
{
    const merlin_calibration *c = context;
    fprintf(out, LIGHT_LIST_OF_CALIBRATION " a %s ball: x right, y up, z toward the camera.\n",
            c->ball == MERLIN_CHROME_BALL ? "chrome" : "matte");
    for (int i = 0; i < c->count; i++) {
        const float *d = c->lights[i].direction;
        fprintf(out, "%.6f %.6f %.6f\n", (double)d[0], (double)d[1], (double)d[2]);
    }
}

static void draw_light(const merlin_calibration *c, int i, float scale, canvas_drawing *d)
{
    double x = c->circle.x * scale, y = c->circle.y * scale, r = c->circle.radius * scale;
    double tip_x = x + r * c->lights[i].direction[0], tip_y = y - r * c->lights[i].direction[1];
    fprintf(d->out,
            "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#8ab4f8\" stroke-width=\"1.2\" "
            "marker-end=\"url(#tip)\"/>\n<text x=\"%.1f\" y=\"%.1f\" font-size=\"11\" fill=\"#fdd663\">%d</text>\n",
            x, y, tip_x, tip_y, tip_x + 4, tip_y - 4, i + 1);
    if (!c->highlights) return;
    fprintf(d->out,
            "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"none\" stroke=\"#f28b82\" stroke-width=\"1.2\"/>\n",
            c->highlights[i].x * scale, c->highlights[i].y * scale, c->highlights[i].radius * scale + 1);
}

static void draw_all(const merlin_calibration *c, float scale, canvas_drawing *d)
{
    fputs("<defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" "
          "orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#8ab4f8\"/></marker></defs>\n",
          d->out);
    fprintf(d->out,
            "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"none\" stroke=\"#81c995\" stroke-width=\"1.5\"/>\n",
            c->circle.x * scale, c->circle.y * scale, c->circle.radius * scale);
    for (int i = 0; i < c->count; i++)
        draw_light(c, i, scale, d);
}

/* Draws an arrow as long as the ball's radius for a light at the side, and a point for one behind the camera. */
static status write_picture(const merlin_calibration *c, const char *path)
{
    static const float LARGEST = 1280;
    int width = c->brightest.width, height = c->brightest.height;
    float scale = LARGEST / (float)(width > height ? width : height);
    img shown;
    canvas paper = {0};
    canvas_drawing drawing;
    int shown_width = (int)fmaxf(1, lroundf((float)width * scale));
    int shown_height = (int)fmaxf(1, lroundf((float)height * scale));
    status s = img_resize(&c->brightest, shown_width, shown_height, &shown);
    if (s != OK) return s;
    s = canvas_new(&paper, shown_width, shown_height);
    if (s == OK) canvas_paste(&paper, &shown, 0, 0);
    if (s == OK) s = canvas_draw_begin(&paper, &drawing);
    if (s == OK) {
        draw_all(c, scale, &drawing);
        s = canvas_draw_end(&paper, &drawing);
    }
    if (s == OK) s = canvas_write(&paper, path);
    canvas_free(&paper);
    img_free(&shown);
    return s;
}

merlin_status merlin_calibration_write(const merlin_calibration *calibration, const char *folder, merlin_files *written)
{
    const merlin_calibration *c = calibration;
    status s = api_needs(__func__, c && folder);
    if (s == OK && (!c->lights || !c->brightest.data)) s = fail(MERLIN_WRONG_USE, "this calibration is empty");
    if (s != OK) return s;
    const char *const inputs[STAGING_MOST_INPUTS] = {c->mask_file};
    staging *t;
    char lights[PATH_MAX], picture[PATH_MAX];
    s = staging_begin(folder, inputs, &t);
    if (s != OK) return s;
    s = write_picture(c, staging_path(t, "calibration.png", picture));
    if (s == OK) s = file_print(staging_path(t, "lights.txt", lights), print_lights, c);
    return s == OK ? staging_commit(t, written) : staging_abort(t, s);
}

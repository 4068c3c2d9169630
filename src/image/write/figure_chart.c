/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "image/write/canvas.h"
#include "image/write/figure.h"

enum { PLOT_WIDTH = 844, CHART_HEIGHT = 600, LEFT = 88, RIGHT = 28, TOP = 56, BOTTOM = 72, MAX_TICKS = 32 };
/* Gap between plot and legend, and mean width of a character of the legend, pixels. */
enum { LEGEND_GAP = 20, LETTER = 8 };

static const char *const palette[] = {"#8ab4f8", "#f28b82", "#81c995", "#fdd663", "#c58af9",
                                      "#78d9ec", "#fcad70", "#ff8bcb", "#c6e377", "#4db6ac",
                                      "#bcaaa4", "#ffffff", "#a1662f", "#5c7cfa", "#9aa0a6"};
enum { PALETTE_SIZE = sizeof palette / sizeof *palette };

/* One axis: values low..high at pixels first..last; for a logarithmic axis their logarithms. */
typedef struct axis {
    double low, high, first, last;
    bool logarithmic;
    double ticks[MAX_TICKS];
    int tick_count;
} axis;

static double place(const axis *a, double value)
{
    double v = a->logarithmic ? log10(value) : value;
    return a->first + (v - a->low) / (a->high - a->low) * (a->last - a->first);
}

static bool is_shown(const axis *a, double value)
{
    return isfinite(value) && (!a->logarithmic || value > 0);
}

static void add_tick(axis *a, double value)
{
    if (a->tick_count < MAX_TICKS) a->ticks[a->tick_count++] = value;
}

/* Chooses ticks at 1, 2 or 5 times a power of ten; with `widen` the range grows to whole steps. */
static void linear_ticks(axis *a, int about, bool widen)
{
    double rough = (a->high - a->low) / about, power = pow(10, floor(log10(rough))), ratio = rough / power;
    double step = power * (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10);
    if (widen) {
        a->low = floor(a->low / step) * step;
        a->high = ceil(a->high / step) * step;
    }
    double first = ceil(a->low / step - 1e-9), last = floor(a->high / step + 1e-9);
    for (double k = first; k <= last && a->tick_count < MAX_TICKS; k++)
        add_tick(a, k == 0 ? 0 : k * step);
}

/* Chooses ticks at powers of ten, thinned if there are many, with 2 and 5 between them if there are few. */
static void logarithmic_ticks(axis *a)
{
    static const double between[] = {1, 2, 5};
    double decades = a->high - a->low;
    int parts = decades < 3 ? 3 : 1, every = decades > 10 ? (int)ceil(decades / 10) : 1;
    for (int e = (int)floor(a->low); e <= (int)ceil(a->high); e += every)
        for (int i = 0; i < parts; i++) {
            double value = between[i] * pow(10, e), l = log10(value);
            if (l >= a->low - 1e-9 && l <= a->high + 1e-9) add_tick(a, value);
        }
}

/* Finds the range of all shown points, in y or in x. */
static void find_range(axis *a, const figure_curve *curves, int count, bool of_y)
{
    a->low = INFINITY;
    a->high = -INFINITY;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < curves[i].count; k++) {
            double v = of_y ? curves[i].y[k] : curves[i].x[k];
            if (!is_shown(a, v)) continue;
            v = a->logarithmic ? log10(v) : v;
            a->low = fmin(a->low, v);
            a->high = fmax(a->high, v);
        }
    if (a->low > a->high) {
        a->low = 0;
        a->high = 1;
    }
    double size = fmax(fabs(a->low), fabs(a->high)), least = a->logarithmic ? 0.2 : size > 0 ? 1e-3 * size : 1;
    double missing = least - (a->high - a->low);
    if (missing > 0) {
        a->low -= missing / 2;
        a->high += missing / 2;
    }
}

static void draw_text(canvas_drawing *d, const char *attributes, double x, double y, const char *words)
{
    fprintf(d->out, "<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, attributes);
    canvas_print_escaped(d, words);
    fputs("</text>\n", d->out);
}

static void draw_axes(canvas_drawing *d, const axis *x, const axis *y)
{
    const char *small = "font-size=\"13\" fill=\"#bdc1c6\" text-anchor=\"middle\"";
    const char *beside = "font-size=\"13\" fill=\"#bdc1c6\" text-anchor=\"end\"";
    char words[32];
    fputs("<g stroke=\"#3c4043\" stroke-width=\"1\">\n", d->out);
    for (int i = 0; i < x->tick_count; i++) {
        double at = floor(place(x, x->ticks[i])) + 0.5;
        fprintf(d->out, "<path d=\"M%.1f %.1fV%.1f\"/>\n", at, y->first, y->last);
    }
    for (int i = 0; i < y->tick_count; i++) {
        double at = floor(place(y, y->ticks[i])) + 0.5;
        fprintf(d->out, "<path d=\"M%.1f %.1fH%.1f\"/>\n", x->first, at, x->last);
    }
    fprintf(d->out, "<path stroke=\"#9aa0a6\" fill=\"none\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n</g>\n", x->first + 0.5,
            y->last, y->first + 0.5, x->last);
    for (int i = 0; i < x->tick_count; i++) {
        snprintf(words, sizeof words, "%g", x->ticks[i]);
        draw_text(d, small, place(x, x->ticks[i]), y->first + 20, words);
    }
    for (int i = 0; i < y->tick_count; i++) {
        snprintf(words, sizeof words, "%g", y->ticks[i]);
        draw_text(d, beside, x->first - 9, place(y, y->ticks[i]) + 4.5, words);
    }
}

/* Draws a line through the shown points and a dot for a single one; there is a gap where points are left out. */
static void draw_curve(canvas_drawing *d, const axis *x, const axis *y, const figure_curve *curve, const char *color)
{
    double last_x = NAN, last_y = NAN;
    bool down = false;
    fprintf(d->out,
            "<path fill=\"none\" stroke=\"%s\" stroke-width=\"1.8\" stroke-linejoin=\"round\" "
            "stroke-linecap=\"round\" d=\"",
            color);
    for (int i = 0; i < curve->count; i++) {
        if (!is_shown(x, curve->x[i]) || !is_shown(y, curve->y[i])) {
            down = false;
            continue;
        }
        double at_x = place(x, curve->x[i]), at_y = place(y, curve->y[i]);
        if (down && fabs(at_x - last_x) < 0.1 && fabs(at_y - last_y) < 0.1) continue;
        /* the move is followed by a line of zero length, which a round cap shows as a dot */
        fprintf(d->out, down ? "L%.1f %.1f" : "M%.1f %.1fh0", at_x, at_y);
        last_x = at_x;
        last_y = at_y;
        down = true;
    }
    fputs("\"/>\n", d->out);
}

/* Returns the distance from the top at which a curve ends; a curve that shows nothing ends at the bottom. */
static double end_of(const axis *x, const axis *y, const figure_curve *curve)
{
    for (int i = curve->count - 1; i >= 0; i--)
        if (is_shown(x, curve->x[i]) && is_shown(y, curve->y[i])) return place(y, curve->y[i]);
    return y->first;
}

/* Draws the names beside the plot, in the order in which the curves end there. */
static void draw_legend(canvas_drawing *d, const axis *x, const axis *y, const figure_curve *curves, int count)
{
    for (int i = 0; i < count; i++) {
        double end = end_of(x, y, &curves[i]), at_x = x->last + LEGEND_GAP, at_y = y->last + 12;
        for (int k = 0; k < count; k++) {
            double other = end_of(x, y, &curves[k]);
            if (other < end || (other <= end && k < i)) at_y += 20;
        }
        if (!curves[i].label) continue;
        fprintf(d->out, "<path stroke=\"%s\" stroke-width=\"3\" stroke-linecap=\"round\" d=\"M%.1f %.1fh20\"/>\n",
                palette[i % PALETTE_SIZE], at_x, at_y - 4.5);
        draw_text(d, "font-size=\"13\"", at_x + 32, at_y, curves[i].label);
    }
}

/* Returns the width that the legend needs beside the plot. */
static int legend_width(const figure_curve *curves, int count)
{
    size_t longest = 0;
    for (int i = 0; i < count; i++)
        if (curves[i].label && strlen(curves[i].label) > longest) longest = strlen(curves[i].label);
    return longest ? LEGEND_GAP + 32 + LETTER * (int)longest : 0;
}

static void draw_titles(canvas_drawing *d, const char *title, const char *x_label, const char *y_label)
{
    double middle_x = LEFT + PLOT_WIDTH / 2.0, middle_y = (TOP + CHART_HEIGHT - BOTTOM) / 2.0;
    char turned[96];
    snprintf(turned, sizeof turned, "font-size=\"14\" text-anchor=\"middle\" transform=\"rotate(-90 22 %.1f)\"",
             middle_y);
    draw_text(d, "font-size=\"18\" text-anchor=\"middle\"", middle_x, 34, title ? title : "");
    draw_text(d, "font-size=\"14\" text-anchor=\"middle\"", middle_x, CHART_HEIGHT - 20, x_label ? x_label : "");
    draw_text(d, turned, 22, middle_y, y_label ? y_label : "");
}

status figure_chart(const char *path, const char *title, const char *x_label, const char *y_label, bool log_y,
                    const figure_curve *curves, int count)
{
    axis x = {.first = LEFT, .last = LEFT + PLOT_WIDTH};
    axis y = {.first = CHART_HEIGHT - BOTTOM, .last = TOP, .logarithmic = log_y};
    find_range(&x, curves, count, false);
    find_range(&y, curves, count, true);
    linear_ticks(&x, 8, false);
    if (log_y)
        logarithmic_ticks(&y);
    else
        linear_ticks(&y, 6, true);
    canvas c;
    status s = canvas_new(&c, LEFT + PLOT_WIDTH + RIGHT + legend_width(curves, count), CHART_HEIGHT);
    if (s != OK) return s;
    canvas_drawing d;
    s = canvas_draw_begin(&c, &d);
    if (s == OK) {
        draw_axes(&d, &x, &y);
        for (int i = 0; i < count; i++)
            draw_curve(&d, &x, &y, &curves[i], palette[i % PALETTE_SIZE]);
        draw_legend(&d, &x, &y, curves, count);
        draw_titles(&d, title, x_label, y_label);
        s = canvas_draw_end(&c, &d);
    }
    if (s == OK) s = canvas_write(&c, path);
    canvas_free(&c);
    return s;
}

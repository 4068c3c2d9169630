/* SPDX-License-Identifier: MIT */
/* merlin/rti: pictures of an object under many lights, made into one that is relit in a browser (reflectance
 * transformation imaging).
 *
 *     merlin_rti *rti;
 *     if (merlin_rti_new(1024, 768, &(merlin_rti_params){.basis = MERLIN_RTI_HSH}, &rti)) ...
 *     for (int i = 0; i < 50; i++) merlin_rti_add(rti, &picture[i], direction[i]);
 *     merlin_rti_write(rti, "coin.rti", NULL);
 *     merlin_rti_free(rti);
 *
 * The files are those of relight and OpenLIME (Visual Computing Lab, CNR-ISTI), and classic .ptm files of RTIViewer.
 * As their viewers do, all of this is about values encoded as sRGB, not linear ones. */
#ifndef MERLIN_RTI_H
#define MERLIN_RTI_H

#include <merlin/files.h>
#include <merlin/image.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How the values of a pixel depend on the light's direction (x, y, z). */
typedef enum merlin_rti_basis {
    MERLIN_RTI_PTM,  /* polynomial texture map, a polynomial of degree 2 in x and y for each channel (Malzbender, Gelb
                      * and Wolters 2001): 18 planes */
    MERLIN_RTI_LRGB, /* the same, one polynomial for the brightness, times a colour: 9 planes */
    MERLIN_RTI_HSH,  /* hemispherical harmonics of degree 2 for each channel (Gautron et al. 2004): 27 planes */
    MERLIN_RTI_RBF,  /* interpolation between the pictures, which principal components represent (Ponchio, Corsini and
                      * Scopigno 2018): as many planes as asked for */
} merlin_rti_basis;

enum {
    MERLIN_RTI_MOST_SIDE = 16384,
    MERLIN_RTI_MOST_PICTURES = 999,
    MERLIN_RTI_MOST_RBF_PICTURES = 300,
    MERLIN_RTI_PLANES = 18,
    MERLIN_RTI_MOST_PLANES = 27,
    MERLIN_RTI_QUALITY = 95,
};

/* All zeros is the usual case. */
typedef struct merlin_rti_params {
    merlin_rti_basis basis;
    int planes;  /* number of planes of MERLIN_RTI_RBF: a multiple of 3 up to MERLIN_RTI_MOST_PLANES; 0:
                    MERLIN_RTI_PLANES */
    int quality; /* quality of the planes' JPEG files, 1 to 100; 0: MERLIN_RTI_QUALITY */
} merlin_rti_params;

typedef struct merlin_rti merlin_rti;

/* Makes one without pictures. Memory, a pixel: 72 bytes of PTM and LRGB and 108 of HSH, however many pictures are
 * added; of RBF 3 for each picture. params NULL: the usual case. */
merlin_status merlin_rti_new(int width, int height, const merlin_rti_params *params, merlin_rti **out);
/* Adds a picture, 3 linear channels of that size, whose values are clamped to [0, 1] and kept at 8 bits. direction:
 * from the object toward its light, of any length above 0, x right, y up, z > 0 toward the camera. */
merlin_status merlin_rti_add(merlin_rti *rti, const merlin_image *picture, const float direction[3]);
/* Writes info.json and plane_0.jpg and on into a folder, which is made if need be: all of them or, after a failure,
 * none. written may be NULL. MERLIN_WRONG_USE for fewer pictures than a basis has terms (6 of PTM and LRGB, 9 of HSH,
 * 4 of RBF), or if their lights lie so that these cannot be told apart. */
merlin_status merlin_rti_write(const merlin_rti *rti, const char *folder, merlin_files *written);
/* Writes one .ptm file (PTM_1.2) of MERLIN_RTI_PTM (PTM_FORMAT_RGB) or MERLIN_RTI_LRGB (PTM_FORMAT_LRGB). */
merlin_status merlin_rti_write_ptm(const merlin_rti *rti, const char *path);
void merlin_rti_free(merlin_rti *rti);

#ifdef __cplusplus
}
#endif

#endif

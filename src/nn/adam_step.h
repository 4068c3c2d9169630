/* SPDX-License-Identifier: MIT */
/* The arguments of Adam's step on a device, for one parameter at a time. Internal to src/nn. */
#ifndef MERLIN_NN_ADAM_STEP_H
#define MERLIN_NN_ADAM_STEP_H

typedef struct adam_step {
    float learning_rate, beta1, beta2, epsilon;
    float correction1, correction2; /* 1 - beta^t */
    float gradient_scale;           /* factor from clipping */
    float kept;                     /* share of the value that decay leaves, before the step */
} adam_step;

#endif

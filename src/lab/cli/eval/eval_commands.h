/* SPDX-License-Identifier: MIT */
/* The verbs of merlin-lab eval that have a file of their own. */
#ifndef MERLIN_LAB_CLI_EVAL_COMMANDS_H
#define MERLIN_LAB_CLI_EVAL_COMMANDS_H

/* Runs merlin-lab eval stereo; argv[0] is "stereo". Returns the exit status. */
int eval_stereo(int argc, char **argv);

/* Runs merlin-lab eval photos; argv[0] is "photos". Returns the exit status. */
int eval_photos(int argc, char **argv);

/* Runs merlin-lab eval solvers; argv[0] is "solvers". Returns the exit status. */
int eval_solvers(int argc, char **argv);

/* Runs merlin-lab eval detail; argv[0] is "detail". Returns the exit status. */
int eval_detail(int argc, char **argv);

/* Runs merlin-lab eval doubts; argv[0] is "doubts". Returns the exit status. */
int eval_doubts(int argc, char **argv);

/* Runs merlin-lab eval masks; argv[0] is "masks". Returns the exit status. */
int eval_masks(int argc, char **argv);

/* Runs merlin-lab eval pictures; argv[0] is "pictures". Returns the exit status. */
int eval_pictures(int argc, char **argv);
/* Runs merlin-lab eval lights; argv[0] is "lights". Returns the exit status. */
int eval_lights(int argc, char **argv);
/* Runs merlin-lab eval several; argv[0] is "several". Returns the exit status. */
int eval_several(int argc, char **argv);
/* Runs merlin-lab eval unknown; argv[0] is "unknown". Returns the exit status. */
int eval_unknown(int argc, char **argv);
/* Run merlin-lab eval table1, table2 and table3; argv[0] is the verb. Return the exit status. */
int eval_table1(int argc, char **argv);
int eval_table2(int argc, char **argv);
int eval_table3(int argc, char **argv);

#endif

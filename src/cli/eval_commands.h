/* The verbs of merlin eval that have a file of their own. */
#ifndef MERLIN_CLI_EVAL_COMMANDS_H
#define MERLIN_CLI_EVAL_COMMANDS_H

/* merlin eval stereo; argv[0] is "stereo". Returns the exit status. */
int eval_stereo(int argc, char **argv);

/* merlin eval photos; argv[0] is "photos". Returns the exit status. */
int eval_photos(int argc, char **argv);

/* merlin eval solvers; argv[0] is "solvers". Returns the exit status. */
int eval_solvers(int argc, char **argv);

/* merlin eval detail; argv[0] is "detail". Returns the exit status. */
int eval_detail(int argc, char **argv);

/* merlin eval doubts; argv[0] is "doubts". Returns the exit status. */
int eval_doubts(int argc, char **argv);

/* merlin eval masks; argv[0] is "masks". Returns the exit status. */
int eval_masks(int argc, char **argv);

/* merlin eval pictures; argv[0] is "pictures". Returns the exit status. */
int eval_pictures(int argc, char **argv);
/* merlin eval lights; argv[0] is "lights". Returns the exit status. */
int eval_lights(int argc, char **argv);

#endif

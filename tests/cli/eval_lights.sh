#!/usr/bin/env bash
# merlin eval lights: the table once with a tiny model, and one line for each kind of bad input.

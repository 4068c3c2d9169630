/* SPDX-License-Identifier: MIT */
/* Runs a command and prints, behind all it prints, the most memory that it held, in MB (10^6 bytes): peak_memory
 * COMMAND... exits as the command does. */
#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

int main(int argc, char **argv)
{
    struct rusage used;
    int how;
    if (argc < 2) return 2;
    pid_t child = fork();
    if (child == 0) {
        execvp(argv[1], argv + 1);
        perror(argv[1]);
        _exit(127);
    }
    if (child < 0 || wait4(child, &how, 0, &used) != child) return 126;
    printf("%.0f\n", (double)used.ru_maxrss * 1024e-6);
    return WIFEXITED(how) ? WEXITSTATUS(how) : 126;
}

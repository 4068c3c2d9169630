#include "base/library.h"

#include <dlfcn.h>
#include <string.h>

bool library_load(const char *file, const library_function *functions, size_t count)
{
    void *library = dlopen(file, RTLD_LAZY | RTLD_LOCAL);
    bool found = library != NULL;
    for (size_t i = 0; found && i < count; i++) {
        /* dlsym gives functions as objects, which C does not turn into each other */
        void *function = dlsym(library, functions[i].name);
        memcpy(functions[i].into, &function, sizeof function);
        found = function != NULL;
    }
    return found;
}

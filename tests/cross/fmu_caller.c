/* The smallest tool that flies an FMU of version 2.0: ten seconds from a hover, the stick moved, and every output
   in bits on standard output. The same source for Windows and for other systems.

   fmu_caller LIBRARY TOKEN LOG START LOG_FILE STICK_AFT OUTPUT COUNT
   the last five are value references, and the number of outputs */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <windows.h>
#define LOADED(path) LoadLibraryA(path)
#define FOUND(library, name) GetProcAddress(library, name)
#else
#include <dlfcn.h>
#define LOADED(path) dlopen(path, RTLD_NOW | RTLD_LOCAL)
#define FOUND(library, name) dlsym(library, name)
#endif

typedef unsigned int Reference;
typedef void (*Logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    Logger logger;
    void *allocate, *free, *step_finished, *environment;
} Callbacks;

static void told(void *environment, const char *instance, int status, const char *category, const char *words, ...)
{
    (void)environment, (void)category;
    fprintf(stderr, "%s: status %d: %s\n", instance, status, words);
}

static void must(int status, const char *what)
{
    if (status != 0) {
        fprintf(stderr, "fmu_caller: %s: status %d\n", what, status);
        exit(1);
    }
}

#define FUNCTION(result, name, ...) \
    result (*name)(__VA_ARGS__) = (result (*)(__VA_ARGS__))FOUND(library, #name); \
    if (!name) { fprintf(stderr, "fmu_caller: no %s\n", #name); return 1; }

int main(int count, char **arguments)
{
    if (count != 9) {
        fprintf(stderr, "fmu_caller: expected 8 arguments, got %d\n", count - 1);
        return 2;
    }
    void *library = (void *)LOADED(arguments[1]);
    if (!library) {
        fprintf(stderr, "fmu_caller: cannot load %s\n", arguments[1]);
        return 1;
    }
    FUNCTION(const char *, fmi2GetVersion, void)
    FUNCTION(void *, fmi2Instantiate, const char *, int, const char *, const char *, const Callbacks *, int, int)
    FUNCTION(void, fmi2FreeInstance, void *)
    FUNCTION(int, fmi2SetupExperiment, void *, int, double, double, int, double)
    FUNCTION(int, fmi2EnterInitializationMode, void *)
    FUNCTION(int, fmi2ExitInitializationMode, void *)
    FUNCTION(int, fmi2Terminate, void *)
    FUNCTION(int, fmi2SetString, void *, const Reference *, size_t, const char *const *)
    FUNCTION(int, fmi2SetReal, void *, const Reference *, size_t, const double *)
    FUNCTION(int, fmi2GetReal, void *, const Reference *, size_t, double *)
    FUNCTION(int, fmi2DoStep, void *, double, double, int)

    const Reference texts[] = {atoi(arguments[4]), atoi(arguments[5])};
    const char *values[] = {"hover-50ft", arguments[3]};
    const Reference stick_aft = atoi(arguments[6]), first = atoi(arguments[7]);
    const size_t outputs = atoi(arguments[8]);
    Reference *references = calloc(outputs, sizeof *references);
    double *given = calloc(outputs, sizeof *given);
    for (size_t at = 0; at < outputs; at++) references[at] = first + (Reference)at;

    const Callbacks callbacks = {told, 0, 0, 0, 0};
    void *xv15 = fmi2Instantiate("caller", 1, arguments[2], "", &callbacks, 0, 0);
    if (!xv15) return 1;
    printf("FMI %s\n", fmi2GetVersion());
    must(fmi2SetString(xv15, texts, 2, values), "parameters");
    must(fmi2SetupExperiment(xv15, 0, 0, 0, 0, 0), "setup");
    must(fmi2EnterInitializationMode(xv15), "initialization");
    must(fmi2ExitInitializationMode(xv15), "start");
    for (int tick = 0; tick < 2500; tick++) {
        const double at = tick >= 125 && tick < 250 ? 0.1 : 0.0;
        must(fmi2SetReal(xv15, &stick_aft, 1, &at), "stick");
        must(fmi2DoStep(xv15, tick * 0.004, 0.004, 1), "step");
        must(fmi2GetReal(xv15, references, outputs, given), "outputs");
        for (size_t output = 0; output < outputs; output++) {
            unsigned long long bits;
            memcpy(&bits, &given[output], sizeof bits);
            printf("%d %u %08lx%08lx\n", tick, references[output], (unsigned long)(bits >> 32),
                   (unsigned long)(bits & 0xffffffff));
        }
    }
    must(fmi2Terminate(xv15), "end");
    fmi2FreeInstance(xv15);
    return 0;
}

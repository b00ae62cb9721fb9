/* program STATES RESULTS: reads (q, qd, qdd) of all samples, writes the results, prints ns per sample.

   The file that includes this defines JOINTS (16 at most), ENTRIES (doubles of a result) and evaluate,
   which returns where the result lies. */
#include <stdio.h>
#include <time.h>

#define SAMPLES 264
#define PASSES 20
#define TIMINGS 20

static const double *evaluate(const double *q, const double *qd, const double *qdd);

static const double *at(const double *state) {
    return evaluate(state, state + JOINTS, state + 2 * JOINTS);
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

int main(int argc, char **argv) {
    static double states[SAMPLES * 3 * 16];
    const int size = 3 * JOINTS;
    FILE *in = argc == 3 ? fopen(argv[1], "rb") : NULL;
    FILE *out = in ? fopen(argv[2], "wb") : NULL;
    if (!out || fread(states, sizeof(double) * size, SAMPLES, in) != SAMPLES) return 1;
    for (int i = 0; i < SAMPLES; i++) fwrite(at(states + i * size), sizeof(double), ENTRIES, out);
    fclose(out);
    double best = 1e99;
    for (int timing = 0; timing < TIMINGS; timing++) {
        double begin = now();
        for (int pass = 0; pass < PASSES; pass++)
            for (int i = 0; i < SAMPLES; i++) {
                const double *result = at(states + i * size);
                __asm__ volatile("" : : "r"(result) : "memory");
            }
        double ns = (now() - begin) / (PASSES * SAMPLES);
        if (ns < best) best = ns;
    }
    printf("%.2f\n", best);
    return 0;
}

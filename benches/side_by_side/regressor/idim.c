/* The C that idim generates. */
#include "robot.h"
#define ENTRIES (JOINTS * COLUMNS)
#include "harness.h"

static const double *evaluate(const double *q, const double *qd, const double *qdd) {
    static double result[JOINTS][COLUMNS];
    robot_D(q, qd, qdd, result);
    return result[0];
}

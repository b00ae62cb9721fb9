// Pinocchio's regressor of an arm of revolute joints, its templates compiled here.
//
// ARM in arm.h are the joints' placements: rotation by rows, then translation.
#include <pinocchio/multibody.hpp>
#include <pinocchio/algorithm/regressor.hpp>

#include "arm.h"

#define ENTRIES (10 * JOINTS * JOINTS)
#include "harness.h"

static const double placements[JOINTS][12] = {ARM};

static pinocchio::Model build() {
    using Rotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    pinocchio::Model model;
    pinocchio::JointIndex parent = 0;
    for (const double *placement : placements) {
        const Eigen::Matrix3d rotation = Eigen::Map<const Rotation>(placement);
        const Eigen::Vector3d translation = Eigen::Map<const Eigen::Vector3d>(placement + 9);
        const pinocchio::SE3 frame(rotation, translation);
        parent = model.addJoint(parent, pinocchio::JointModelRZ(), frame, "joint" + std::to_string(parent));
    }
    return model;
}

// Column by column.
static const double *evaluate(const double *q, const double *qd, const double *qdd) {
    using Vector = Eigen::Map<const Eigen::VectorXd>;
    static const pinocchio::Model model = build();
    static pinocchio::Data data(model);
    pinocchio::computeJointTorqueRegressor(model, data, Vector(q, JOINTS), Vector(qd, JOINTS), Vector(qdd, JOINTS));
    return data.jointTorqueRegressor.data();
}

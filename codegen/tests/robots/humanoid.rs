//! A made-up humanoid of thirty joints, as the text of a URDF: waist, neck, two legs, two arms.

use std::fmt::Write;

/// Axis and offset (m) of each joint of a limb.
type Limb = [(char, [f64; 3])];

const WAIST: [(char, [f64; 3]); 2] = [('z', [0.0, 0.0, 0.1]), ('x', [-0.004, 0.0, 0.044])];
const NECK: [(char, [f64; 3]); 2] = [('z', [0.0, 0.0, 0.45]), ('y', [0.01, 0.0, 0.06])];
const LEG: [(char, [f64; 3]); 6] = [
    ('z', [0.0, 0.085, -0.02]),
    ('x', [0.021, 0.004, -0.087]),
    ('y', [-0.033, 0.066, -0.031]),
    ('y', [0.0, -0.006, -0.35]),
    ('y', [0.0, 0.0, -0.32]),
    ('x', [0.012, 0.0, -0.018]),
];
const ARM: [(char, [f64; 3]); 7] = [
    ('y', [0.004, 0.1, 0.24]),
    ('x', [0.0, 0.038, -0.014]),
    ('z', [0.0, 0.006, -0.103]),
    ('y', [0.016, 0.0, -0.081]),
    ('x', [0.1, 0.002, -0.01]),
    ('y', [0.038, 0.0, 0.0]),
    ('z', [0.046, 0.0, 0.0]),
];

/// The description; every link has a mass.
pub fn urdf() -> String {
    let mut text = String::from("<?xml version=\"1.0\"?>\n<robot name=\"humanoid\">\n");
    link(&mut text, "pelvis", 0);
    limb(&mut text, "waist", "pelvis", &WAIST, 1.0);
    limb(&mut text, "neck", "waist_2", &NECK, 1.0);
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        limb(&mut text, &format!("{side}_leg"), "pelvis", &LEG, sign);
        limb(&mut text, &format!("{side}_arm"), "waist_2", &ARM, sign);
    }
    text + "</robot>\n"
}

fn limb(text: &mut String, name: &str, root: &str, limb: &Limb, side: f64) {
    let mut parent = root.to_owned();
    for (index, (axis, [x, y, z])) in limb.iter().enumerate() {
        let child = format!("{name}_{}", index + 1);
        link(text, &child, index + 1);
        let axis = ["x", "y", "z"].map(|own| u8::from(own == axis.to_string()).to_string());
        writeln!(
            text,
            "  <joint name=\"{child}_joint\" type=\"revolute\">\n    \
             <parent link=\"{parent}\"/><child link=\"{child}\"/>\n    \
             <origin xyz=\"{x} {} {z}\"/><axis xyz=\"{}\"/>\n    \
             <limit lower=\"-2\" upper=\"2\" velocity=\"10\" effort=\"80\"/>\n  </joint>",
            side * y,
            axis.join(" ")
        )
        .unwrap();
        parent = child;
    }
}

fn link(text: &mut String, name: &str, index: usize) {
    let size = 1.0 / (1.0 + index as f64);
    writeln!(
        text,
        "  <link name=\"{name}\"><inertial>\n    \
         <origin xyz=\"0.01 0.02 {}\"/><mass value=\"{}\"/>\n    \
         <inertia ixx=\"{}\" ixy=\"0.0001\" ixz=\"0.0002\" iyy=\"{}\" iyz=\"0.0001\" izz=\"{}\"/>\n  \
         </inertial></link>",
        -0.05 * size,
        4.0 * size,
        0.02 * size,
        0.02 * size,
        0.01 * size
    )
    .unwrap();
}

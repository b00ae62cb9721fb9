//! One body among the described ones that move together.

use idim_codegen::describe::UrdfInertial;
use idim_codegen::emit::urdf::inertial;
use idim_codegen::mechanism::{Body, Joint, Mechanism, Standard};
use idim_runtime::physical::Pseudo;
use nalgebra::Matrix4;

/// The inertial values of every described body that has a mass, so that those which move together
/// come to the given links.
///
/// Bodies keep their shares: with the described whole \\( P = L L^T \\) and the wanted one
/// \\( P' = L' L'^T \\), each P_i becomes \\( A P_i A^T \\), \\( A = L' L^{-1} \\), which is positive
/// definite where P_i is and adds up to P'. Where the described whole is no body, each gets its
/// share of the mass of the wanted one.
pub fn shares(mechanism: &Mechanism, links: &[Standard]) -> Vec<(String, UrdfInertial)> {
    let pairs = mechanism.joints.iter().zip(links);
    pairs
        .flat_map(|(joint, wanted)| of_link(joint, wanted))
        .collect()
}

fn of_link(joint: &Joint, wanted: &Standard) -> Vec<(String, UrdfInertial)> {
    let heavy: Vec<(&Body, Standard)> = joint
        .bodies
        .iter()
        .filter_map(|body| Some((body, body.inertial.filter(|i| i.mass > 0.0)?)))
        .collect();
    let written = |body: &Body, own: Standard| {
        let own = own.moved(&body.pose.inverse());
        (body.name.clone(), inertial(&own))
    };
    match (heavy.as_slice(), joint.bodies.first()) {
        ([], Some(first)) => vec![written(first, *wanted)],
        ([(body, _)], _) => vec![written(body, *wanted)],
        (heavy, _) => {
            let whole = heavy
                .iter()
                .fold(Standard::zero(), |sum, (_, own)| sum.plus(own));
            let change = change(&whole, wanted);
            let share = |own: &Standard| match &change {
                Some(change) => standard(&(change * matrix(own) * change.transpose())),
                None => standard(&(matrix(wanted) * (own.mass / whole.mass))),
            };
            heavy
                .iter()
                .map(|(body, own)| written(body, share(own)))
                .collect()
        }
    }
}

/// A, if there is one.
fn change(described: &Standard, wanted: &Standard) -> Option<Matrix4<f64>> {
    let root = |body: &Standard| matrix(body).cholesky().map(|root| root.l());
    Some(root(wanted)? * root(described)?.try_inverse()?)
}

fn matrix(body: &Standard) -> Matrix4<f64> {
    let rows = Pseudo::of(&body.values()).0;
    Matrix4::from_fn(|i, k| rows[i][k])
}

fn standard(matrix: &Matrix4<f64>) -> Standard {
    let rows = std::array::from_fn(|i| std::array::from_fn(|k| matrix[(i, k)]));
    Standard::from_values(Pseudo(rows).values())
}

#[cfg(test)]
mod tests {
    use super::*;
    use idim_codegen::builder::read_texts;

    const TWO: &str = r#"<robot name="two"><link name="base"/>
<link name="arm"><inertial><origin xyz="0.1 0 0"/><mass value="2"/>
<inertia ixx="0.02" iyy="0.03" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="frame"/>
<link name="tool"><inertial><origin xyz="0 0 0.05"/><mass value="0.5"/>
<inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j" type="continuous"><parent link="base"/><child link="arm"/></joint>
<joint name="f" type="fixed"><parent link="arm"/><child link="frame"/></joint>
<joint name="t" type="fixed"><origin xyz="0.4 0 0" rpy="0 1 0"/><parent link="arm"/><child link="tool"/></joint>
</robot>"#;

    #[test]
    fn shares_are_bodies_and_come_to_the_whole() {
        let robot = read_texts(&[("two.urdf", TWO)]).unwrap();
        let joint = &robot.mechanism.joints[0];
        let wanted = Standard::from_values(Pseudo::ball(3.0, 0.15, [0.2, 0.02, -0.01]).values());
        let shares = of_link(joint, &wanted);
        let names: Vec<&str> = shares.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["arm", "tool"]);
        let mut sum = Standard::zero();
        for (name, inertial) in &shares {
            let body = joint.bodies.iter().find(|body| body.name == *name).unwrap();
            let own = Standard::from_urdf(inertial).moved(&body.pose);
            assert!(Pseudo::of(&own.values()).exists(), "{name}");
            sum = sum.plus(&own);
        }
        for (a, b) in sum.values().iter().zip(wanted.values()) {
            assert!((a - b).abs() < 1e-13);
        }
        // As described, the shares are the described bodies.
        for (name, inertial) in of_link(joint, &joint.carried()) {
            let mass = if name == "arm" { 2.0 } else { 0.5 };
            assert!((inertial.mass - mass).abs() < 1e-12);
        }
    }
}

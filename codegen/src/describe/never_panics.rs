//! No text makes the readers panic, overflow the stack or return an error without a diagnostic.

use super::{Kind, read_text};
use proptest::prelude::*;

const URDF: &str = r#"<?xml version="1.0"?>
<robot name="arm" version="1.1">
  <link name="base"/>
  <link name="upper">
    <inertial>
      <origin xyz="0 0 0.1" rpy="0 1.57 0"/>
      <mass value="1.5"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.015"/>
    </inertial>
    <visual><geometry><mesh filename="upper.stl"/></geometry></visual>
  </link>
  <link name="tool"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/>
    <child link="upper"/>
    <origin xyz="0 0 0.3" quat_xyzw="0 0 0 1"/>
    <axis xyz="0 0.6 0.8"/>
    <limit lower="-1" upper="1" effort="10" velocity="2"/>
    <dynamics damping="0.1" friction="0.2"/>
  </joint>
  <joint name="mount" type="fixed">
    <parent link="upper"/>
    <child link="tool"/>
    <mimic joint="shoulder"/>
  </joint>
</robot>
"#;

const PAR: &str = "(* Robotname = 'arm' *)
NL = 3
NJ = 3
Type = 1
is_floating = 0
D3 = 0.4
ant = {0,1,
  1}
Sigma = {0,1,2}
alpha = {0,Pi/2,-atan2(1,2)}
d = {0,D3*cos(Pi/3),(D3 + 0.1)/2}
theta = {th1 - Pi/2,0,0}
XX = {1,XX2,0}
M = {2.5,M2,0}
FV = {FV1,0.1,0}
FX = {FX1,0,0}
G = {0,0,G3}
";

const TOML: &str = r#"name = "arm"
gravity = [0, 0, -9.81]
effects = ["viscous", { kind = "coulomb", smoothing = 0.05 }]
[lengths]
L = 0.5
H = "2*L"
[[joint]]
name = "shoulder"
kind = "revolute"
alpha = "pi/2"
d = "L*cos(pi/3) - (H + 0.1)/2"
limits = [-1, 1]
[[joint]]
name = "elbow"
kind = "prismatic"
ant = 1
limits = { lower = 0, upper = 1, velocity = 2, effort = 3 }
effects = ["offset"]
[[effect]]
kind = "wrist_coupling"
joints = ["shoulder", "elbow"]
[identify]
fq_hz = 8
border = [1, 2]
edges = "matlab"
[drives]
gains = [1.0, 2.0]
coupling = [[1, 0], [0.5, 1]]
[parameters]
ZZ1 = 3.5
[prior]
mass = 0.1
[[link]]
name = "elbow"
mass = 2.0
box = [[-0.1, -0.1, 0], ["L", 0.1, 0.2]]
symmetric = ["xy", "xz"]
[scaled]
LMX2 = "L*MX2"
"#;

const COMPANION: &str = r#"urdf = "arm.urdf"
[joint.shoulder]
gain = 2.0
limits = [-1, 1]
effects = ["viscous"]
[drives]
torque = "commanded"
side = "link"
"#;

/// What a mutation puts in: pieces that mean something somewhere, and numbers at the edge.
const PIECES: [&str; 40] = [
    "<",
    ">",
    "/>",
    "</",
    "\"",
    "'",
    "&",
    "&#0;",
    "<!--",
    "-->",
    "<![CDATA[",
    "]]>",
    "<!DOCTYPE a>",
    "<?",
    "=",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    ",",
    ".",
    "\n",
    "\0",
    "é",
    "\u{FEFF}",
    "\u{1F916}",
    "nan",
    "inf",
    "-1e308",
    "1e-320",
    "0",
    "-",
    "((",
    "sqrt(",
    "${x}",
    "joint",
    "link",
    "xmlns:a=\"b\"",
];

#[derive(Clone, Debug)]
enum Edit {
    Insert(prop::sample::Index, usize),
    Delete(prop::sample::Index, usize),
    Copy(prop::sample::Index, prop::sample::Index, usize),
}

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let at = any::<prop::sample::Index>;
    let edit = prop_oneof![
        (at(), 0..PIECES.len()).prop_map(|(place, piece)| Edit::Insert(place, piece)),
        (at(), 1..40usize).prop_map(|(place, length)| Edit::Delete(place, length)),
        (at(), at(), 1..60usize).prop_map(|(from, to, length)| Edit::Copy(from, to, length)),
    ];
    prop::collection::vec(edit, 1..6)
}

fn edited(text: &str, edits: &[Edit]) -> String {
    let mut letters: Vec<char> = text.chars().collect();
    for edit in edits {
        let place = |index: &prop::sample::Index, all: &[char]| index.index(all.len() + 1);
        match edit {
            Edit::Insert(at, piece) => {
                let at = place(at, &letters);
                letters.splice(at..at, PIECES[*piece].chars());
            }
            Edit::Delete(at, length) => {
                let at = place(at, &letters);
                letters.drain(at..(at + length).min(letters.len()));
            }
            Edit::Copy(from, to, length) => {
                let from = place(from, &letters);
                let piece = letters[from..(from + length).min(letters.len())].to_vec();
                let to = place(to, &letters);
                letters.splice(to..to, piece);
            }
        }
    }
    letters.into_iter().collect()
}

/// Reads the text as both kinds, and as the URDF of a companion.
fn read_as_anything(text: &str) {
    let load = |_: &str| Ok(text.to_owned());
    for (read, kind) in [
        (text, Kind::Urdf),
        (text, Kind::Toml),
        (text, Kind::Par),
        (COMPANION, Kind::Toml),
    ] {
        if let Err(errors) = read_text(read, "any", kind, &load) {
            assert!(!errors.is_empty());
            assert!(errors.iter().all(|one| !one.message.is_empty()));
        }
    }
}

#[test]
fn read_text_unedited_samples_are_descriptions() {
    let urdf = URDF.replace("<mimic joint=\"shoulder\"/>", "");
    let load = |_: &str| Ok(urdf.clone());
    for (text, kind) in [
        (urdf.as_str(), Kind::Urdf),
        (TOML, Kind::Toml),
        (PAR, Kind::Par),
        (COMPANION, Kind::Toml),
    ] {
        let read = read_text(text, "sample", kind, &load);
        assert!(read.is_ok(), "{:?}", read.err());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn read_text_any_text_does_not_panic(text in "\\PC{0,200}") {
        read_as_anything(&text);
    }

    #[test]
    fn read_text_edited_urdf_does_not_panic(edits in edits()) {
        read_as_anything(&edited(URDF, &edits));
    }

    #[test]
    fn read_text_edited_toml_does_not_panic(edits in edits()) {
        read_as_anything(&edited(TOML, &edits));
    }

    #[test]
    fn read_text_edited_par_does_not_panic(edits in edits()) {
        read_as_anything(&edited(PAR, &edits));
    }

    #[test]
    fn read_text_edited_companion_does_not_panic(edits in edits()) {
        let load = |_: &str| Ok(URDF.to_owned());
        let _ = read_text(&edited(COMPANION, &edits), "any", Kind::Toml, &load);
    }
}

//! The codes of diagnostics: stable, grouped by what they are about, explained in
//! `docs/diagnostics.md`.
//!
//! 00x files, 01x XML as such, 02x elements and attributes, 03x names and tree, 04x values,
//! 05x TOML, 06x effects and drives, 07x SYMORO's `.par`, 1xx warnings.

/// A file cannot be opened or read.
pub const FILE_UNREADABLE: &str = "IDIM001";
/// A file is larger than any description should be.
pub const FILE_TOO_LARGE: &str = "IDIM002";
/// A file is not UTF-8 text.
pub const FILE_NOT_UTF8: &str = "IDIM003";
/// A format that is not read (yet).
pub const FILE_FORMAT: &str = "IDIM004";
/// Another kind of file than its name says: MJCF, SDF, a mesh.
pub const FILE_CONTENT: &str = "IDIM005";

/// Not well-formed XML.
pub const XML_SYNTAX: &str = "IDIM010";
/// Elements nested too deeply.
pub const XML_DEPTH: &str = "IDIM011";
/// A document type declaration.
pub const XML_DTD: &str = "IDIM012";
/// More links or elements than any robot has.
pub const XML_COUNT: &str = "IDIM013";
/// Macros that nobody expanded.
pub const XACRO: &str = "IDIM014";
/// The URDF reader refused what passed every check here.
pub const URDF_REFUSED: &str = "IDIM015";

/// An element without a name.
pub const NAME_MISSING: &str = "IDIM020";
/// An attribute that is needed is not there.
pub const ATTRIBUTE_MISSING: &str = "IDIM021";
/// A child element that is needed is not there.
pub const ELEMENT_MISSING: &str = "IDIM022";
/// A child element that may be there once is there twice.
pub const ELEMENT_REPEATED: &str = "IDIM023";
/// An element where every reader overlooks it.
pub const ELEMENT_MISPLACED: &str = "IDIM024";
/// An element that is almost a known one.
pub const ELEMENT_UNKNOWN: &str = "IDIM025";
/// An attribute that is almost a known one.
pub const ATTRIBUTE_UNKNOWN: &str = "IDIM026";

/// Two links, or two joints, of one name.
pub const NAME_REPEATED: &str = "IDIM030";
/// A parent or child link that does not exist.
pub const LINK_UNKNOWN: &str = "IDIM031";
/// A link that is the child of two joints.
pub const SEVERAL_PARENTS: &str = "IDIM032";
/// Links that are their own ancestors.
pub const CYCLE: &str = "IDIM033";
/// More than one link without a parent.
pub const SEVERAL_ROOTS: &str = "IDIM034";
/// Nothing moves.
pub const NO_MOVING_JOINT: &str = "IDIM035";
/// Two joint names that become one identifier.
pub const NAMES_COLLIDE: &str = "IDIM036";
/// An antecedent that is not an earlier row.
pub const ANTECEDENT: &str = "IDIM037";

/// Not a number.
pub const NUMBER_INVALID: &str = "IDIM040";
/// NaN or infinite.
pub const NUMBER_NOT_FINITE: &str = "IDIM041";
/// Not as many numbers as there should be.
pub const NUMBER_COUNT: &str = "IDIM042";
/// An axis without a direction.
pub const AXIS_ZERO: &str = "IDIM043";
/// Lower limit above the upper one.
pub const LIMITS_REVERSED: &str = "IDIM044";
/// A number that is not admissible there.
pub const NUMBER_RANGE: &str = "IDIM045";
/// A joint type that does not exist.
pub const JOINT_TYPE_UNKNOWN: &str = "IDIM046";
/// A joint type, or a coupling of joints, that is not modelled.
pub const JOINT_UNSUPPORTED: &str = "IDIM047";
/// An expression that cannot be evaluated.
pub const EXPRESSION: &str = "IDIM048";

/// Not TOML.
pub const TOML_SYNTAX: &str = "IDIM050";
/// A key that means nothing there.
pub const KEY_UNKNOWN: &str = "IDIM051";
/// A value of another type than the key takes.
pub const VALUE_TYPE: &str = "IDIM052";
/// A key that is needed is not there.
pub const KEY_MISSING: &str = "IDIM053";
/// A word that is none of the admissible ones.
pub const WORD_UNKNOWN: &str = "IDIM054";
/// Keys that contradict each other.
pub const KEYS_EXCLUDE: &str = "IDIM055";
/// A name of a length or parameter that cannot be one.
pub const NAME_INVALID: &str = "IDIM056";

/// An effect that the catalogue does not have.
pub const EFFECT_UNKNOWN: &str = "IDIM060";
/// An effect on a joint that does not exist or does not move.
pub const EFFECT_JOINT: &str = "IDIM061";
/// An effect on fewer or more joints than it takes.
pub const EFFECT_ARITY: &str = "IDIM062";
/// The same effect twice on one joint.
pub const EFFECT_REPEATED: &str = "IDIM063";
/// Not one value per moving joint.
pub const JOINT_COUNT: &str = "IDIM064";
/// A coupling matrix that cannot be inverted.
pub const COUPLING_SINGULAR: &str = "IDIM065";
/// A `[scaled]` entry that is not a factor times a parameter.
pub const SCALED: &str = "IDIM066";
/// A `[[link]]` for what does not exist or does not move.
pub const LINK_STATED: &str = "IDIM067";

/// What is neither `key = value` nor `key = {values}`.
pub const PAR_SYNTAX: &str = "IDIM070";
/// A closed loop.
pub const CLOSED_LOOP: &str = "IDIM071";

/// A moving link without inertial values.
pub const MASSLESS: &str = "IDIM100";
/// A mass that is zero or negative.
pub const MASS_NOT_POSITIVE: &str = "IDIM101";
/// An inertia tensor that no body has.
pub const INERTIA_IMPOSSIBLE: &str = "IDIM102";
/// A joint without limits, or with limits that say nothing.
pub const LIMITS_MISSING: &str = "IDIM103";
/// An axis whose length is not 1.
pub const AXIS_NOT_UNIT: &str = "IDIM104";
/// Meshes, which are not read.
pub const MESHES_IGNORED: &str = "IDIM105";
/// A value that looks like degrees or millimetres.
pub const UNIT_DOUBTFUL: &str = "IDIM106";
/// Joints that had to be put into the order from base to tip.
pub const JOINTS_REORDERED: &str = "IDIM107";
/// A link and a joint of one name.
pub const NAME_SHARED: &str = "IDIM108";
/// Joint damping or friction below zero.
pub const DAMPING_NEGATIVE: &str = "IDIM109";
/// What a `.par` says and the model leaves out.
pub const PAR_LEFT_OUT: &str = "IDIM110";

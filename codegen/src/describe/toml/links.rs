//! `total_mass` and `[[link]]`: what is known of bodies beside any log.

use super::super::check;
use super::super::code;
use super::super::description::{Geometry, LinkSpec, MirrorPlane, Motion, UrdfTree};
use super::super::findings::{Findings, finding};
use super::table::{Table, Value};
use super::value;
use toml::de::DeValue;

const POSITIVE: (f64, f64) = (f64::MIN_POSITIVE, f64::MAX);

const AXES: [&str; 3] = ["x", "y", "z"];

const PLANES: [(&str, MirrorPlane); 3] = [
    ("xy", MirrorPlane::Xy),
    ("xz", MirrorPlane::Xz),
    ("yz", MirrorPlane::Yz),
];

/// Reads `total_mass`, kg.
pub(super) fn total_mass(table: &mut Table<'_>, to: &mut Findings) -> Option<f64> {
    let value = table.get("total_mass")?;
    value::number_within(value, "`total_mass`", POSITIVE, to)
}

/// Reads `[[link]]`, and goes on after a bad one.
pub(super) fn read(
    table: &mut Table<'_>,
    geometry: &Geometry,
    lengths: &[(String, f64)],
    to: &mut Findings,
) -> Vec<LinkSpec> {
    let values = table.get("link");
    let values = values.and_then(|value| value::list(value, "`link` (written [[link]])", to));
    let names = moving(geometry);
    let mut links: Vec<LinkSpec> = Vec::new();
    for (index, value) in values.unwrap_or_default().into_iter().enumerate() {
        let Some(link) = one(index, value, &names, lengths, to) else {
            continue;
        };
        if let Some(before) = links.iter().find(|before| before.name == link.name) {
            let message = format!("two [[link]] are called `{}`", link.name);
            let help = format!("the first one is on line {}; make it one", before.span.line);
            to.error_at(link.span, finding(code::NAME_REPEATED, message).help(help));
        }
        links.push(link);
    }
    links
}

fn one(
    index: usize,
    value: Value<'_>,
    names: &[&str],
    lengths: &[(String, f64)],
    to: &mut Findings,
) -> Option<LinkSpec> {
    let mut table = Table::from_value(value, &format!("link {}", index + 1), to)?;
    let named = table.need("name", to)?;
    let name = value::text(named, &table.path("name"), to)?;
    table.name = format!("link `{name}`");
    if !names.contains(&name) {
        let message = format!("there is no joint or moving link `{name}`");
        let help = to.suggest(name, names.iter().copied());
        let found = finding(code::LINK_STATED, message).help(help);
        to.error(named.span().start, found);
    }
    let mass = table
        .get("mass")
        .and_then(|value| value::number_within(value, &table.path("mass"), POSITIVE, to));
    let corners = table
        .get("box")
        .and_then(|value| corners(value, &table.path("box"), lengths, to));
    let symmetric = table
        .get("symmetric")
        .and_then(|value| planes(value, &table.path("symmetric"), to));
    let span = to.span(table.offset);
    table.finish(to);
    Some(LinkSpec {
        name: name.to_owned(),
        mass,
        corners,
        symmetric: symmetric.unwrap_or_default(),
        span,
    })
}

/// The lowest and the highest corner of a box.
fn corners(
    value: Value<'_>,
    what: &str,
    lengths: &[(String, f64)],
    to: &mut Findings,
) -> Option<[[f64; 3]; 2]> {
    let rows = value::list(value, what, to)?;
    let rows: Option<Vec<[f64; 3]>> = rows
        .into_iter()
        .map(|row| corner(row, what, lengths, to))
        .collect();
    let Ok([lowest, highest]) = <[[f64; 3]; 2]>::try_from(rows?) else {
        let help = "[[xmin, ymin, zmin], [xmax, ymax, zmax]], m";
        let message = format!("{what} takes two corners");
        to.error(
            value.span().start,
            finding(code::NUMBER_COUNT, message).help(help),
        );
        return None;
    };
    let mut pairs = AXES.into_iter().zip(lowest.into_iter().zip(highest));
    if let Some((axis, (low, high))) = pairs.find(|(_, (low, high))| low >= high) {
        let message = format!("{what}: along {axis}, {low} is not below {high}");
        let help = "the lowest corner first, then the highest";
        to.error(
            value.span().start,
            finding(code::LIMITS_REVERSED, message).help(help),
        );
        return None;
    }
    let far = lowest.into_iter().chain(highest);
    let far = far.fold(0.0, |far: f64, x| far.max(x.abs()));
    if far > check::DOUBTFUL_LENGTH {
        to.warn(value.span().start, check::doubtful_length(what, far));
    }
    Some([lowest, highest])
}

fn corner(
    value: Value<'_>,
    what: &str,
    lengths: &[(String, f64)],
    to: &mut Findings,
) -> Option<[f64; 3]> {
    let values = value::list(value, what, to)?;
    let found: Vec<Option<f64>> = values
        .into_iter()
        .map(|one| value::quantity(one, what, lengths, to).map(|found| found.value))
        .collect();
    let found: Vec<f64> = found.into_iter().collect::<Option<_>>()?;
    let count = found.len();
    let corner = <[f64; 3]>::try_from(found).ok();
    if corner.is_none() {
        let message = format!("a corner of {what} has {count} numbers instead of 3");
        to.error(value.span().start, finding(code::NUMBER_COUNT, message));
    }
    corner
}

/// `"xy"`, or an array of such.
fn planes(value: Value<'_>, what: &str, to: &mut Findings) -> Option<Vec<MirrorPlane>> {
    let values = match value.get_ref() {
        DeValue::Array(values) => values.iter().collect(),
        _ => vec![value],
    };
    let planes: Vec<Option<MirrorPlane>> = values
        .into_iter()
        .map(|one| value::word(one, what, &PLANES, to))
        .collect();
    planes.into_iter().collect()
}

/// Joints that move, and links that move with them.
fn moving(geometry: &Geometry) -> Vec<&str> {
    match geometry {
        Geometry::Mdh(rows) => {
            let rows = rows.iter().filter(|row| row.motion != Motion::Fixed);
            rows.map(|row| row.name.as_str()).collect()
        }
        Geometry::Urdf(tree) => {
            let joints = tree.joints.iter().filter(|j| j.motion != Motion::Fixed);
            let links = (0..tree.links.len()).filter(|link| carried(tree, *link));
            joints
                .map(|joint| joint.name.as_str())
                .chain(links.map(|link| tree.links[link].name.as_str()))
                .collect()
        }
    }
}

/// Whether a joint between a link and the root moves.
fn carried(tree: &UrdfTree, link: usize) -> bool {
    let mut at = link;
    // A tree: no way to the root is longer than there are joints.
    for _ in 0..tree.joints.len() {
        match tree.joints.iter().find(|joint| joint.child == at) {
            Some(joint) if joint.motion != Motion::Fixed => return true,
            Some(joint) => at = joint.parent,
            None => return false,
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use crate::describe::{Description, Diagnostic, Kind, MirrorPlane, read_text};

    const ROWS: &str = "[lengths]\nL = 0.4\n[[joint]]\nname = \"upper\"\nkind = \"revolute\"\n\
        [[joint]]\nname = \"flange\"\nkind = \"fixed\"\nd = \"L\"\n";

    fn read(text: &str) -> Result<Description, Vec<Diagnostic>> {
        let text = format!("total_mass = 7.5\n{ROWS}{text}");
        read_text(&text, "robot.toml", Kind::Toml, &|_| Err(String::new()))
    }

    #[test]
    fn read_link_gives_mass_box_and_planes() {
        let text = "[[link]]\nname = \"upper\"\nmass = 4.2\nsymmetric = [\"xy\", \"xz\"]\n\
            box = [[-0.1, -0.05, -0.05], [\"L + 0.1\", 0.05, 0.05]]\n";
        let robot = read(text).unwrap();
        assert_eq!(robot.total_mass, Some(7.5));
        let [link] = &robot.links[..] else {
            panic!("{:?}", robot.links)
        };
        assert_eq!((link.name.as_str(), link.mass), ("upper", Some(4.2)));
        let corners = [[-0.1, -0.05, -0.05], [0.5, 0.05, 0.05]];
        assert_eq!(link.corners, Some(corners));
        assert_eq!(link.symmetric, [MirrorPlane::Xy, MirrorPlane::Xz]);
        let one = read("[[link]]\nname = \"upper\"\nsymmetric = \"yz\"\n").unwrap();
        assert_eq!(one.links[0].symmetric, [MirrorPlane::Yz]);
    }

    #[test]
    fn read_wrong_links_says_where_and_why() {
        let errors = |text: &str| {
            let found = read(&format!("[[link]]\n{text}\n")).unwrap_err();
            found[0].to_string()
        };
        for (text, wanted) in [
            (
                "name = \"uper\"",
                "robot.toml:12:8: error [IDIM067]: there is no joint or moving link `uper`\n  \
                 help: did you mean `upper`?",
            ),
            (
                "name = \"flange\"",
                "[IDIM067]: there is no joint or moving link `flange`",
            ),
            (
                "mass = 1",
                "robot.toml:11:1: error [IDIM053]: link 1 has no `name`",
            ),
            (
                "name = \"upper\"\nmass = -1",
                "robot.toml:13:8: error [IDIM045]: `mass` of link `upper` must be positive, not -1",
            ),
            (
                "name = \"upper\"\nbox = [[0, 0, 0]]",
                "robot.toml:13:7: error [IDIM042]: `box` of link `upper` takes two corners",
            ),
            (
                "name = \"upper\"\nbox = [[0, 0], [1, 1, 1]]",
                "robot.toml:13:8: error [IDIM042]: a corner of `box` of link `upper` has 2 numbers",
            ),
            (
                "name = \"upper\"\nbox = [[0, 0.2, 0], [1, 0.1, 1]]",
                "robot.toml:13:7: error [IDIM044]: `box` of link `upper`: along y, 0.2 is not below 0.1",
            ),
            (
                "name = \"upper\"\nsymmetric = \"yx\"",
                "robot.toml:13:13: error [IDIM054]: `symmetric` of link `upper` cannot be `yx`",
            ),
            (
                "name = \"upper\"\ncolour = \"red\"",
                "[IDIM051]: unknown key `colour` in link `upper`",
            ),
            (
                "name = \"upper\"\n[[link]]\nname = \"upper\"",
                "robot.toml:13:1: error [IDIM030]: two [[link]] are called `upper`",
            ),
        ] {
            let found = errors(text);
            assert!(found.contains(wanted), "{found}\n{wanted}");
        }
        let text = format!("total_mass = 0\n{ROWS}");
        let massless = read_text(&text, "robot.toml", Kind::Toml, &|_| Err(String::new()));
        let found = massless.unwrap_err()[0].to_string();
        let wanted = "robot.toml:1:14: error [IDIM045]: `total_mass` must be positive, not 0";
        assert!(found.contains(wanted), "{found}");
    }

    #[test]
    fn read_box_in_millimetres_is_doubted() {
        let robot = read("[[link]]\nname = \"upper\"\nbox = [[-100, -50, -50], [400, 50, 50]]\n");
        let warnings = robot.unwrap().warnings;
        assert!(warnings[0].to_string().contains("lengths are in metres"));
    }

    #[test]
    fn read_link_of_a_urdf_has_to_move() {
        let urdf = "<robot name=\"arm\"><link name=\"base\"/><link name=\"foot\"/>\
            <link name=\"upper\"/><link name=\"tool\"/>\
            <joint name=\"f\" type=\"fixed\"><parent link=\"base\"/><child link=\"foot\"/></joint>\
            <joint name=\"j\" type=\"continuous\"><parent link=\"foot\"/><child link=\"upper\"/></joint>\
            <joint name=\"g\" type=\"fixed\"><parent link=\"upper\"/><child link=\"tool\"/></joint>\
            </robot>";
        let read = |name: &str| {
            let text = format!("urdf = \"arm.urdf\"\n[[link]]\nname = \"{name}\"\nmass = 1\n");
            read_text(&text, "robot.toml", Kind::Toml, &|_| Ok(urdf.to_owned()))
        };
        for name in ["j", "upper", "tool"] {
            assert_eq!(read(name).unwrap().links[0].name, name);
        }
        for name in ["base", "foot", "f"] {
            assert!(read(name).unwrap_err()[0].to_string().contains("IDIM067"));
        }
    }
}

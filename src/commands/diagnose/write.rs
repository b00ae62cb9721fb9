//! `--write FILE`: the description with what was found.

use std::path::{Component, Path, PathBuf};

use idim::catalogue::{Extension, toml};
use idim::codegen::BuildError;
use idim::codegen::base::BaseError;
use idim::codegen::builder;
use idim::codegen::describe::identifier::snake_case;
use idim::runtime::report::{Diagnosis, FoundEffect, Refitted, parameter, place};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, value};

use crate::commands::robot::Texts;
use crate::commands::{Failure, output};

/// Writes the description of a robot with the effects and the refitted parameters. It is read back
/// before, so that what is there afterwards is a robot.
///
/// # Errors
/// [`Failure::Write`]; [`Failure::Usage`] where another file would have to be replaced;
/// [`Failure::Defect`] if what would be written is no description.
pub fn write(
    path: &Path,
    texts: &Texts,
    diagnosis: &Diagnosis,
    extension: &Extension,
) -> Result<(), Failure> {
    let mut document = document(texts)?;
    if let Some(name) = name(path) {
        document["name"] = value(name);
    }
    let geometry = geometry(path, texts, &mut document)?;
    let mut remarks = remarks(diagnosis, extension);
    effects(&mut document, extension, &mut remarks)?;
    parameters(&mut document, diagnosis, extension, remarks)?;
    let text = document.to_string();
    check(&text, texts, &document, extension)?;
    if let Some((path, text)) = geometry {
        output::write_whole(&path, &text)?;
    }
    output::text(path, &text)
}

/// Why there is no robot with what was found.
pub fn not_extended(source: BaseError) -> Failure {
    Failure::Description(BuildError::Base {
        file: "the description with what was found".into(),
        source,
    })
}

/// What the terminal says of it.
pub fn summary(path: &Path, diagnosis: &Diagnosis, extension: &Extension) -> String {
    let effects = match extension.specs.len() {
        0 => "no further effect".to_owned(),
        1 => "1 effect more".to_owned(),
        n => format!("{n} effects more"),
    };
    let mut text = format!(
        "\nwritten: {}, the description with {effects} and its {} parameters refitted\n",
        path.display(),
        extension.parameters.len()
    );
    for (place, belongs) in &extension.elsewhere {
        text += &format!(
            "  not in it as an effect: {}; it belongs to {belongs}\n",
            title(&diagnosis.effects[*place])
        );
    }
    text
}

/// The description as a document: its own TOML, or a companion of its URDF.
fn document(texts: &Texts) -> Result<DocumentMut, Failure> {
    if texts.is_par() {
        return Err(Failure::Usage {
            message: "a .par cannot hold the effects that a diagnosis finds".into(),
            help: "write its table as [[joint]] rows in a .toml, and diagnose with that".into(),
        });
    }
    if !texts.is_toml() {
        return Ok(DocumentMut::new());
    }
    let text = texts.description().1;
    text.trim_start_matches('\u{feff}')
        .parse()
        .map_err(|error| {
            Failure::Defect(format!("a description that was read is no TOML: {error}"))
        })
}

/// A robot is called like its file.
fn name(path: &Path) -> Option<String> {
    let name = snake_case(&path.file_stem()?.to_string_lossy());
    (!name.is_empty() && path != Path::new("-")).then_some(name)
}

/// Sets the path of the URDF, if there is one, as seen from the new file. The URDF of a built-in
/// robot is written beside it.
fn geometry(
    path: &Path,
    texts: &Texts,
    document: &mut DocumentMut,
) -> Result<Option<(PathBuf, String)>, Failure> {
    let Some((named, text)) = texts.urdf() else {
        return Ok(None);
    };
    let to = path.parent().unwrap_or(Path::new(""));
    if let Some(folder) = &texts.folder {
        document["urdf"] = value(relative(&folder.join(named), to));
        return Ok(None);
    }
    let file = Path::new(named).file_name().unwrap_or_default();
    let beside = to.join(file);
    document["urdf"] = value(file.to_string_lossy().into_owned());
    match std::fs::read_to_string(&beside) {
        Ok(known) if known == *text => Ok(None),
        Ok(_) => Err(Failure::Usage {
            message: format!(
                "{} is there and is not the URDF of this robot",
                beside.display()
            ),
            help: "write to another folder".into(),
        }),
        Err(_) => Ok(Some((beside, text.clone()))),
    }
}

/// A file as seen from a folder, with `/` between the parts.
fn relative(file: &Path, from: &Path) -> String {
    let here = |path: &Path| match path.as_os_str().is_empty() {
        true => PathBuf::from("."),
        false => path.to_owned(),
    };
    let (Ok(file), Ok(from)) = (here(file).canonicalize(), here(from).canonicalize()) else {
        return file.display().to_string();
    };
    let (file, from): (Vec<Component>, Vec<Component>) =
        (file.components().collect(), from.components().collect());
    let common = file.iter().zip(&from).take_while(|(a, b)| a == b).count();
    let up = from[common..].iter().map(|_| "..".to_owned());
    let down = file[common..]
        .iter()
        .map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

/// What the file says of the diagnosis, as comments.
fn remarks(diagnosis: &Diagnosis, extension: &Extension) -> String {
    let mut text = format!("\n# Found by `{}`:\n", output::command_line());
    if diagnosis.effects.is_empty() {
        text += "# nothing that has a name.\n";
    }
    for (k, effect) in diagnosis.effects.iter().enumerate() {
        text += &format!("# {}\n", title(effect));
        let mut elsewhere = extension.elsewhere.iter();
        if let Some((_, belongs)) = elsewhere.find(|(place, _)| *place == k) {
            for found in &effect.parameters {
                text += &format!("#   {}\n", parameter(found));
            }
            text += &format!("#   no [[effect]]: it belongs to {belongs}\n");
        }
    }
    text
}

fn title(effect: &FoundEffect) -> String {
    format!(
        "{}{}",
        effect.effect,
        place(effect.joint.as_deref(), &effect.joints)
    )
}

/// Adds the `[[effect]]` entries, the remarks before the first of them.
fn effects(
    document: &mut DocumentMut,
    extension: &Extension,
    remarks: &mut String,
) -> Result<(), Failure> {
    let new: DocumentMut = toml(&extension.specs)
        .parse()
        .map_err(|error| Failure::Defect(format!("an effect is no TOML: {error}")))?;
    let Some(new) = new.get("effect").and_then(Item::as_array_of_tables) else {
        return Ok(());
    };
    let own = document
        .entry("effect")
        .or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
    let there = std::mem::take(own).into_array_of_tables();
    let mut all = there.map_err(|_| Failure::Defect("`effect` is no list of tables".into()))?;
    for table in new {
        let mut table = table.clone();
        table.set_position(None);
        table
            .decor_mut()
            .set_prefix(format!("{}\n", std::mem::take(remarks)));
        all.push(table);
    }
    *own = Item::ArrayOfTables(all);
    Ok(())
}

/// Sets the `[parameters]`, each with its standard deviation beside it.
fn parameters(
    document: &mut DocumentMut,
    diagnosis: &Diagnosis,
    extension: &Extension,
    remarks: String,
) -> Result<(), Failure> {
    let known = document.contains_table("prior");
    let own = document
        .entry("parameters")
        .or_insert(Item::Table(Table::new()));
    let table = std::mem::take(own).into_table();
    let mut table = table.map_err(|_| Failure::Defect("`parameters` is no table".into()))?;
    let columns = extension.robot.base.parameters.iter();
    for (column, found) in columns.zip(&extension.parameters) {
        let mut item = value(*found);
        if let Some(value) = item.as_value_mut() {
            let sigma = sigma(diagnosis, &column.name).map_or_else(
                || without_sigma(diagnosis, &column.name, *found).to_owned(),
                |sigma| format!("+- {sigma:.2e}"),
            );
            value
                .decor_mut()
                .set_suffix(format!(" # {sigma} {}", column.unit));
        }
        table.insert(&column.name, item);
    }
    let with = match diagnosis.effects.is_empty() {
        true => "",
        false => " with what was found",
    };
    let mut prefix = match &diagnosis.changed {
        Some(changed) => format!(
            "{remarks}\n# As known from {},{} has changed.\n",
            changed.against.escape_debug(),
            if changed.is_empty() {
                " and nothing"
            } else {
                " with what"
            }
        ),
        None => format!("{remarks}\n# Refitted{with}, on the same logs.\n"),
    };
    if known {
        prefix += "# [prior] now stands about these values: leave it out where the same logs are \
                   used again.\n";
    }
    table.decor_mut().set_prefix(prefix);
    *own = Item::Table(table);
    Ok(())
}

/// What is said of a parameter without a sigma: where parameters are known, whether it is as it was.
fn without_sigma(diagnosis: &Diagnosis, name: &str, found: f64) -> &'static str {
    let mut own = diagnosis.parameters.iter().filter(|own| own.name == name);
    let before = own.next().map_or(0.0, |own| own.before.value);
    match diagnosis.changed.is_some() {
        true if (found - before).abs() <= 1e-9 * before.abs() => "as known,",
        true => "changed,",
        false => "not determined",
    }
}

fn sigma(diagnosis: &Diagnosis, name: &str) -> Option<f64> {
    let own = diagnosis.parameters.iter();
    let own = own.map(|Refitted { name, after, .. }| (name, after.sigma));
    let effects = diagnosis
        .effects
        .iter()
        .flat_map(|effect| &effect.parameters);
    let mut all = own.chain(effects.map(|found| (&found.name, found.sigma)));
    all.find(|(known, _)| *known == name)?.1
}

/// Reads back what is to be written.
fn check(
    text: &str,
    texts: &Texts,
    document: &DocumentMut,
    extension: &Extension,
) -> Result<(), Failure> {
    let mut all = vec![("found.toml", text)];
    if let Some((_, urdf)) = texts.urdf() {
        let named = document.get("urdf").and_then(Item::as_str);
        all.push((named.unwrap_or_default(), urdf));
    }
    let read = builder::read_texts(&all)
        .map_err(|error| Failure::Defect(format!("what would be written is wrong: {error}")))?;
    let names = |robot: &idim::codegen::Robot| -> Vec<String> {
        let parameters = robot.base.parameters.iter();
        parameters.map(|parameter| parameter.name.clone()).collect()
    };
    match names(&read) == names(&extension.robot) {
        true => Ok(()),
        false => Err(Failure::Defect(
            "what would be written has other parameters than what was found".into(),
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_seen_from_a_folder() {
        let folder = tempfile::tempdir().unwrap_or_else(|_| std::process::abort());
        let at = |path: &str| folder.path().join(path);
        for path in ["a/b", "a/c"] {
            assert!(std::fs::create_dir_all(at(path)).is_ok());
        }
        assert!(std::fs::write(at("a/b/arm.urdf"), "").is_ok());
        assert_eq!(relative(&at("a/b/arm.urdf"), &at("a/c")), "../b/arm.urdf");
        assert_eq!(relative(&at("a/b/arm.urdf"), &at("a/b")), "arm.urdf");
        assert_eq!(relative(&at("a/b/arm.urdf"), &at("a")), "b/arm.urdf");
    }

    #[test]
    fn a_robot_is_called_like_its_file() {
        assert_eq!(
            name(Path::new("robots/Lab-Arm 4.toml")).as_deref(),
            Some("lab_arm_4")
        );
        assert_eq!(name(Path::new("-")), None);
    }
}

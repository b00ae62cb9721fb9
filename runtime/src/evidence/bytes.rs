//! The content of an evidence file, without its frame.

use super::error::FormatError;
use super::{Evidence, Layout, Triangle};
use crate::observe::ModelKind;

/// Writes the content; see [`super::file`] for the order.
pub(super) fn write(evidence: &Evidence) -> Vec<u8> {
    let layout = &evidence.layout;
    let mut out = Vec::new();
    text(&mut out, &layout.robot);
    out.push(
        ModelKind::ALL
            .iter()
            .position(|kind| *kind == layout.model)
            .unwrap_or(0) as u8,
    );
    number(&mut out, layout.parameters);
    out.extend(layout.fingerprint.to_le_bytes());
    number(&mut out, layout.names.len());
    layout.names.iter().for_each(|name| text(&mut out, name));
    number(&mut out, layout.joints.len());
    for columns in &layout.joints {
        number(&mut out, columns.len());
        columns.iter().for_each(|column| number(&mut out, *column));
    }
    number(&mut out, evidence.blocks.len());
    for factor in evidence.blocks.iter().flatten() {
        out.extend((factor.rows() as u64).to_le_bytes());
        factor
            .packed()
            .iter()
            .for_each(|entry| out.extend(entry.to_le_bytes()));
    }
    out
}

/// A count; columns and blocks stay far below the limit.
fn number(out: &mut Vec<u8>, value: usize) {
    out.extend(u32::try_from(value).unwrap_or(u32::MAX).to_le_bytes());
}

fn text(out: &mut Vec<u8>, text: &str) {
    number(out, text.len());
    out.extend(text.as_bytes());
}

/// Reads the content and checks that it does not contradict itself.
pub(super) fn read(content: &[u8]) -> Result<Evidence, FormatError> {
    let mut reader = Reader::new(content);
    let layout = layout(&mut reader).ok_or(malformed("its columns are incomplete"))?;
    check(&layout)?;
    let short = malformed("it ends amid a time block");
    let blocks = reader.number().ok_or(short.clone())?;
    let mut evidence = Evidence::empty(layout);
    for _ in 0..blocks {
        let joints = 0..evidence.layout.joints.len();
        let factors = joints.map(|joint| factor(&mut reader, evidence.layout.width(joint)));
        let factors = factors.collect::<Option<Vec<_>>>().ok_or(short.clone())?;
        if factors
            .iter()
            .any(|factor| factor.packed().iter().any(|entry| !entry.is_finite()))
        {
            return Err(malformed("a factor holds a value that is not finite"));
        }
        evidence.blocks.push(factors);
    }
    match reader.rest.is_empty() {
        true => Ok(evidence),
        false => Err(malformed("something follows the last time block")),
    }
}

fn layout(reader: &mut Reader<'_>) -> Option<Layout> {
    let robot = reader.text()?;
    let model = *ModelKind::ALL.get(usize::from(reader.take(1)?[0]))?;
    let parameters = reader.number()?;
    let fingerprint = reader.u64()?;
    let columns = reader.number()?;
    let names = (0..columns).map(|_| reader.text()).collect::<Option<_>>()?;
    let joints = reader.number()?;
    let joints = (0..joints)
        .map(|_| reader.numbers())
        .collect::<Option<_>>()?;
    Some(Layout {
        robot,
        model,
        names,
        parameters,
        joints,
        fingerprint,
    })
}

fn check(layout: &Layout) -> Result<(), FormatError> {
    let ascending = |columns: &Vec<usize>| columns.is_sorted_by(|a, b| a < b);
    let inside = |columns: &Vec<usize>| columns.iter().all(|c| *c < layout.names.len());
    if layout.joints.is_empty() {
        return Err(malformed("there are no joints"));
    }
    if layout.parameters > layout.names.len() {
        return Err(malformed("there are more parameters than columns"));
    }
    match layout
        .joints
        .iter()
        .all(|columns| ascending(columns) && inside(columns))
    {
        true => Ok(()),
        false => Err(malformed(
            "the columns of a joint are out of order or out of range",
        )),
    }
}

fn factor(reader: &mut Reader<'_>, width: usize) -> Option<Triangle> {
    let rows = usize::try_from(reader.u64()?).ok()?;
    let entries = reader.take((width * (width + 1) / 2).checked_mul(8)?)?;
    let (entries, _) = entries.as_chunks::<8>();
    let packed = entries
        .iter()
        .map(|entry| f64::from_le_bytes(*entry))
        .collect();
    Triangle::from_packed(width, rows, packed)
}

fn malformed(what: &'static str) -> FormatError {
    FormatError::Malformed { what }
}

/// Takes bytes off the front; `None` when they run out. Nothing is allocated before the bytes
/// for it have been seen.
pub(super) struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Reader { rest: bytes }
    }

    pub fn take(&mut self, len: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(len)?;
        self.rest = rest;
        Some(taken)
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.take(4)?.try_into().ok().map(u32::from_le_bytes)
    }

    pub fn u64(&mut self) -> Option<u64> {
        self.take(8)?.try_into().ok().map(u64::from_le_bytes)
    }

    fn number(&mut self) -> Option<usize> {
        usize::try_from(self.u32()?).ok()
    }

    fn numbers(&mut self) -> Option<Vec<usize>> {
        let len = self.number()?;
        (0..len).map(|_| self.number()).collect()
    }

    fn text(&mut self) -> Option<String> {
        let len = self.number()?;
        String::from_utf8(self.take(len)?.to_vec()).ok()
    }
}

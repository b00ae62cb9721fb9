//! The evidence file: the same bits back, and an error for anything else.

use proptest::prelude::*;

use super::super::checksum::Checksum;
use super::super::{Cut, Evidence, EvidenceError, FormatError};
use super::{NP, gather, numbers, random};

fn small() -> Evidence {
    gather(&random(1), Cut::Blocks(3))
}

fn reason(bytes: &[u8]) -> FormatError {
    match Evidence::from_bytes(bytes, "test") {
        Err(EvidenceError::File { source, .. }) => source,
        other => panic!("{other:?} is no format error"),
    }
}

/// Sets the checksum right again after a change.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let end = bytes.len() - 8;
    let sum = Checksum::of(&bytes[..end]).to_le_bytes();
    bytes[end..].copy_from_slice(&sum);
    bytes
}

#[test]
fn saved_evidence_is_loaded_with_the_same_bits_and_merges() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.evidence");
    let evidence = small();
    evidence.save(&path).unwrap();
    let mut loaded = Evidence::load(&path).unwrap();
    assert_eq!(loaded, evidence);
    assert_eq!(loaded.to_bytes(), evidence.to_bytes());
    loaded.merge(&evidence).unwrap();
    assert_eq!(loaded.rows(), 2 * evidence.rows());
    let entries = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(entries, 1, "nothing but the file is left behind");
}

#[test]
fn missing_file_is_an_error_with_its_path() {
    let error = Evidence::load(std::path::Path::new("no/such.evidence")).unwrap_err();
    assert!(error.to_string().contains("such.evidence"), "{error}");
}

#[test]
fn file_cut_at_any_length_is_an_error() {
    let bytes = small().to_bytes();
    for len in 0..bytes.len() {
        let expected = FormatError::Cut {
            has: len as u64,
            needs: if len < 20 { 28 } else { bytes.len() as u64 },
        };
        assert_eq!(reason(&bytes[..len]), expected);
    }
}

#[test]
fn other_versions_and_other_files_are_refused() {
    let bytes = small().to_bytes();
    let mut newer = bytes.clone();
    newer[8] = 2;
    assert_eq!(reason(&newer), FormatError::Version { found: 2, known: 1 });
    assert_eq!(reason(b"time,q1,tau1\n0,0,0\n"), FormatError::NotEvidence);
    let mut longer = bytes.clone();
    longer.extend([0; 3]);
    assert_eq!(reason(&longer), FormatError::Trailing { extra: 3 });
}

#[test]
fn sealed_contradictions_are_malformed() {
    let evidence = small();
    let bytes = evidence.to_bytes();
    // After the frame: robot (4 + 3 bytes), model, np.
    let (model, np) = (20 + 7, 20 + 8);
    for (place, value) in [(model, 9), (np, 200), (20, 255), (24, 0xff)] {
        let mut changed = bytes.clone();
        changed[place] = value;
        assert!(matches!(
            reason(&sealed(changed)),
            FormatError::Malformed { .. }
        ));
    }
    let mut infinite = bytes.clone();
    let last = bytes.len() - 16;
    infinite[last..last + 8].copy_from_slice(&f64::INFINITY.to_le_bytes());
    assert!(matches!(
        reason(&sealed(infinite)),
        FormatError::Malformed { .. }
    ));
}

#[test]
fn evidence_of_other_robots_does_not_merge() {
    let observations = random(1);
    let of = |name, np| {
        let robot = numbers(name, np, 3);
        Evidence::from_observations(&robot, &observations, &[], Cut::default()).unwrap()
    };
    let mut evidence = of("arm", NP);
    let mut differs = |other: &Evidence| match evidence.merge(other) {
        Err(EvidenceError::Different { what, .. }) => what,
        other => panic!("{other:?} is no difference"),
    };
    assert_eq!(differs(&of("leg", NP)), "robot");
    assert_eq!(differs(&of("arm", NP + 1)), "columns");
    let mut longer = of("arm", NP);
    longer.layout.fingerprint ^= 1;
    assert_eq!(differs(&longer), "description");
}

proptest! {
    #[test]
    fn damaged_bytes_are_an_error(place in 0usize..4000, flip in 1u8..) {
        let mut bytes = small().to_bytes();
        let place = place % bytes.len();
        bytes[place] ^= flip;
        prop_assert!(Evidence::from_bytes(&bytes, "test").is_err());
    }

    #[test]
    fn sealed_damage_does_not_panic(changes in prop::collection::vec((0usize..300, any::<u8>()), 1..8)) {
        let mut bytes = small().to_bytes();
        for (place, value) in changes {
            bytes[20 + place] = value;
        }
        // It may read, when only names or numbers changed; then it can be asked.
        if let Ok(evidence) = Evidence::from_bytes(&sealed(bytes), "test") {
            let question = super::super::Question::parameters(&evidence, super::super::Weighting::Residual);
            let _ = evidence.fit(&question);
        }
    }

    #[test]
    fn random_bytes_are_an_error(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        prop_assert!(Evidence::from_bytes(&bytes, "test").is_err());
    }
}

use super::*;
use crate::TriMesh;
use crate::tree::tests::torus;
use glam::DVec3;

fn bits(tree: &MeshTree) -> String {
    format!("{tree:?}")
}

/// A checksum as someone who forges a file would put it.
fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.truncate(bytes.len() - CHECKSUM);
    bytes.extend(checksum(&bytes).to_le_bytes());
    bytes
}

#[test]
fn a_tree_comes_back_bit_for_bit() {
    let one = TriMesh::try_new(vec![DVec3::splat(0.1); 3], vec![[0, 1, 2]]).unwrap();
    let tiny = torus(5, 4, 0.1, |p| p * 1e-250);
    let open =
        TriMesh::try_new(torus(9, 5, 0.0, |p| p).vertices().to_vec(), vec![[0, 1, 7], [7, 3, 0]]).unwrap();
    for mesh in [torus(30, 12, 0.01, |p| p * 1e6), one, tiny, open] {
        let tree = MeshTree::new(mesh);
        let bytes = tree.to_bytes();
        let back = MeshTree::try_from_bytes(&bytes).unwrap();
        assert_eq!(bits(&back), bits(&tree));
        assert_eq!(back.mesh(), tree.mesh());
        assert_eq!(back.is_watertight(), tree.is_watertight());
        assert_eq!(back.to_bytes(), bytes);
    }
}

#[cfg(feature = "serde")]
#[test]
fn in_a_serde_format_a_tree_is_its_bytes() {
    let tree = MeshTree::new(torus(30, 12, 0.01, |p| p));
    let text = serde_json::to_string(&tree).unwrap();
    assert_eq!(serde_json::from_str::<Vec<u8>>(&text).unwrap(), tree.to_bytes());
    let back: MeshTree = serde_json::from_str(&text).unwrap();
    assert_eq!(bits(&back), bits(&tree));
    let mut bytes = tree.to_bytes();
    bytes[HEADER] ^= 1;
    let refused = serde_json::from_str::<MeshTree>(&serde_json::to_string(&bytes).unwrap()).unwrap_err();
    assert!(refused.to_string().contains("damaged"), "{refused}");
}

/// The form is a promise to files that exist: a change of it needs another version.
#[test]
fn the_form_of_the_bytes_is_as_documented() {
    let mesh = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]).unwrap();
    let bytes = MeshTree::new(mesh).to_bytes();
    assert_eq!(bytes[..16], *b"d2mtree\0\x02\0\0\0\0\0\0\0");
    assert_eq!(
        bytes[16..40],
        [[3u8, 0, 0, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 0, 0, 0]].concat()
    );
    assert_eq!(bytes[40..48], 0.5f64.to_le_bytes());
    assert_eq!(bytes[HEADER + 24..][..8], 1f64.to_le_bytes());
    assert_eq!(bytes.len(), HEADER + 3 * VERTEX + TRIANGLE + NODE + BOX + CHECKSUM);
}

#[test]
fn every_damaged_byte_is_noticed() {
    let bytes = MeshTree::new(torus(5, 4, 0.01, |p| p)).to_bytes();
    for index in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[index] ^= 1 << (index % 8);
        assert!(MeshTree::try_from_bytes(&damaged).is_err(), "byte {index}");
    }
    for length in 0..bytes.len() {
        assert!(MeshTree::try_from_bytes(&bytes[..length]).is_err(), "{length} bytes");
    }
    assert!(MeshTree::try_from_bytes(&[&bytes[..], &[0]].concat()).is_err());
    assert_eq!(MeshTree::try_from_bytes(b"hello").unwrap_err(), TreeFileError::NotATree);
    let mut other = bytes;
    other[8] = 1;
    assert_eq!(MeshTree::try_from_bytes(&other).unwrap_err(), TreeFileError::Version { found: 1 });
}

/// With the right checksum: nothing panics, nothing takes memory by what is stated, and what is accepted is valid.
#[test]
fn forged_bytes_are_refused_or_valid() {
    let bytes = MeshTree::new(torus(5, 4, 0.01, |p| p)).to_bytes();
    let forged = |at: usize, with: &[u8]| {
        let mut forged = bytes.clone();
        forged[at..at + with.len()].copy_from_slice(with);
        MeshTree::try_from_bytes(&sealed(forged))
    };
    for at in [16, 24, 32] {
        for count in [0, 3, 1 << 40, 1 << 61, u64::MAX] {
            let refused = forged(at, &count.to_le_bytes()).unwrap_err();
            assert!(!matches!(refused, TreeFileError::Damaged { .. }), "{at} {count}: {refused}");
        }
    }
    let not_a_number = f64::NAN.to_le_bytes();
    assert!(matches!(forged(HEADER, &not_a_number), Err(TreeFileError::Mesh(_))));
    assert!(matches!(forged(40, &not_a_number), Err(TreeFileError::Tree(TreeError::Extent))));
    assert!(matches!(forged(64, &f64::INFINITY.to_le_bytes()), Err(TreeFileError::Tree(TreeError::Extent))));
    for at in (16..bytes.len() - CHECKSUM).step_by(4) {
        for with in [0u32, 1, 9, 0x3f80_0000, 0x7f80_0000, u32::MAX] {
            if let Ok(tree) = forged(at, &with.to_le_bytes()) {
                assert_eq!(tree.validate(), Ok(()), "{at} {with}");
            }
        }
    }
}

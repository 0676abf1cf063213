use super::*;

#[test]
fn the_law_holds() {
    for speed in [4.0, 512.0] {
        let trials = generate(&Law { speed, ..Law::PAPER }, 3, 4000);
        let mut misses = 0.0;
        for Trial { a, b } in &trials {
            let (apart, closing) = (b.position - a.position, b.velocity - a.velocity);
            assert!((closing.length() - speed).abs() < 1e-9 * speed);
            assert!(apart.length() > 2.0, "disjoint spheres at the start");
            let nearest = -apart.dot(closing) / closing.length_squared();
            let miss = (apart + closing * nearest).length();
            assert!(miss <= 1.0 + 1e-9 && nearest > 0.0);
            misses += miss * miss / trials.len() as f64;
            for movement in [a, b] {
                assert!(movement.angular_velocity.length() <= 3.0 + 1e-12);
                assert!((movement.rotation.length() - 1.0).abs() < 1e-15);
            }
        }
        // Uniform in the unit disk: the mean of the squared radius is 1/2, its deviation 1/√12.
        assert!((misses - 0.5).abs() < 4.0 * (1.0 / 12.0 / 4000.0f64).sqrt());
    }
}

#[test]
fn a_longer_list_begins_with_the_shorter() {
    let long = generate(&Law::PAPER, 9, 20);
    assert_eq!(generate(&Law::PAPER, 9, 5), long[..5]);
}

#[test]
fn a_file_gives_back_the_same_bits() {
    let path = std::env::temp_dir().join(format!("d2m-trials-{}.csv", std::process::id()));
    let trials = generate(&Law::PAPER, 5, 16);
    write(&path, &trials).unwrap();
    assert_eq!(read(&path).unwrap(), trials);
    std::fs::write(&path, "1,2,nan\n").unwrap();
    let message = read(&path).unwrap_err().to_string();
    assert!(message.contains(":1: column 3"), "{message}");
    std::fs::remove_file(&path).unwrap();
}

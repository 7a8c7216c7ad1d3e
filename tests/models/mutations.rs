//! Damaged files: real ones, cut, flipped and shuffled with fixed seeds. Reading must neither panic nor
//! hang, whatever it finds.

use hairline::exchange::iges;

use crate::iges_truth as truth;

/// Files small enough to damage often.
const FILES: [&str; 12] = [
    "gpucast_teapot.igs",
    "dealii_DTMB-5415_bulbous_bow.iges",
    "dealii_wing.iges",
    "dealii_wigley.iges",
    "tigl_D150_wing.igs",
    "pygem_test_pipe_hollow.iges",
    "igesio_single_rounded_cube.iges",
    "pyiges_144-000.igs",
    "pyiges_144-example-1.igs",
    "pyiges_128-005.igs",
    "elmer_cylinder_in_channel.iges",
    "freecad_SOT23.igs",
];

/// xorshift64*: the same cases on every run.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 33) as usize % n.max(1)
    }
}

/// Starts and ends of the numbers in the data columns.
fn numbers(bytes: &[u8]) -> Vec<(usize, usize)> {
    let mut result = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let length = bytes[at..].iter().take_while(|c| c.is_ascii_digit() || b".+-E".contains(c)).count();
        if length > 0 {
            result.push((at, at + length));
        }
        at += length.max(1);
    }
    result
}

fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    const ODD: [&str; 10] =
        ["NaN", "1E300", "-1", "0", "99999999", "1E-300", "-1E300", "inf", "3HABC", "2147483648"];
    match random.below(6) {
        0 => bytes.truncate(random.below(bytes.len())),
        1 => {
            for _ in 0..=random.below(20) {
                let at = random.below(bytes.len());
                bytes[at] = random.below(256) as u8;
            }
        }
        2 => {
            // A number replaced in place: columns stay where they are.
            for _ in 0..=random.below(6) {
                let all = numbers(bytes);
                let (start, end) = all[random.below(all.len())];
                let odd = ODD[random.below(ODD.len())].as_bytes();
                for (k, slot) in bytes[start..end].iter_mut().enumerate() {
                    *slot = odd.get(k).copied().unwrap_or(b' ');
                }
            }
        }
        3 => {
            // Two numbers change places, pointers among them.
            for _ in 0..=random.below(10) {
                let all = numbers(bytes);
                let (a, b) = (all[random.below(all.len())], all[random.below(all.len())]);
                let (one, two) = (bytes[a.0..a.1].to_vec(), bytes[b.0..b.1].to_vec());
                for k in 0..a.1 - a.0 {
                    bytes[a.0 + k] = two.get(k).copied().unwrap_or(b' ');
                }
                for k in 0..b.1 - b.0 {
                    bytes[b.0 + k] = one.get(k).copied().unwrap_or(b' ');
                }
            }
        }
        4 => {
            let mut lines: Vec<Vec<u8>> = bytes.split(|c| *c == b'\n').map(<[u8]>::to_vec).collect();
            for _ in 0..=random.below(5) {
                let (a, b) = (random.below(lines.len()), random.below(lines.len()));
                if random.below(2) == 0 {
                    lines.swap(a, b);
                } else {
                    lines.remove(a);
                }
            }
            *bytes = lines.join(&b'\n');
        }
        _ => {
            let (from, to) = (random.below(bytes.len()), random.below(bytes.len()));
            let part = bytes[from.min(to)..from.max(to)].to_vec();
            let at = random.below(bytes.len());
            bytes.splice(at..at, part.into_iter().take(4000));
        }
    }
}

#[test]
fn damaged_files_give_faces_remarks_or_an_error() {
    let Some(models) = truth::models() else { return };
    let (mut read, mut refused, mut faces, mut remarks) = (0, 0, 0, 0);
    for (number, name) in FILES.iter().enumerate() {
        let original = std::fs::read(models.join("files").join(name)).unwrap();
        for case in 0..15 {
            let mut random = Random(0x9E37_79B9_7F4A_7C15 ^ (1 + 1000 * number as u64 + case));
            let mut bytes = original.clone();
            for _ in 0..=random.below(3) {
                if !bytes.is_empty() {
                    damage(&mut bytes, &mut random);
                }
            }
            match iges::read_bytes(&bytes) {
                Ok((model, report)) => {
                    read += 1;
                    faces += model.faces.len();
                    remarks += report.remarks.len();
                    let finite = model.faces.iter().flat_map(|f| &f.loops).flat_map(|l| &l.curves);
                    assert!(finite.flat_map(|c| c.points()).all(|p| p.is_finite()), "{name} {case}");
                }
                Err(error) => {
                    refused += 1;
                    assert!(!error.to_string().is_empty());
                }
            }
        }
    }
    println!("{read} read with {faces} faces and {remarks} remarks, {refused} refused");
    assert!(read > 100 && refused > 3 && remarks > 100);
}

//! The decoders of meshopt streams against meshoptimizer: every mode and version, damaged streams, and all
//! values of the filters.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use darboux_dice::Dice;
use darboux_io::LoadOptions;
use darboux_io::gltf::Document;
use serde_json::json;

/// What a view says about its stream.
#[derive(Clone, Copy, Debug)]
struct View {
    mode: &'static str,
    filter: &'static str,
    stride: usize,
    count: usize,
}

impl View {
    fn attributes(stride: usize, count: usize) -> Self {
        Self { mode: "ATTRIBUTES", filter: "NONE", stride, count }
    }

    fn indices(mode: &'static str, stride: usize, count: usize) -> Self {
        Self { mode, filter: "NONE", stride, count }
    }

    /// The bytes that a document with this stream has.
    fn decode(self, stream: &[u8]) -> Result<Vec<u8>, String> {
        let Self { mode, filter, stride, count } = self;
        let length = count * stride;
        let extension = json!({"buffer": 0, "byteLength": stream.len(), "count": count, "byteStride": stride,
            "mode": mode, "filter": filter});
        let json = json!({
            "asset": {"version": "2.0"},
            "accessors": [{"bufferView": 0, "componentType": 5121, "count": length, "type": "SCALAR"}],
            "bufferViews": [
                {"buffer": 1, "byteLength": length, "extensions": {"KHR_meshopt_compression": extension}},
            ],
            "buffers": [
                {"byteLength": stream.len(), "uri": format!("data:;base64,{}", BASE64_STANDARD.encode(stream))},
                {"byteLength": length},
            ],
        });
        let options = LoadOptions::default();
        let document = Document::from_bytes("x.gltf", json.to_string().into(), None, &options)
            .map_err(|error| error.to_string())?;
        Ok(document.elements(0).map_err(|error| error.to_string())?.bytes)
    }
}

/// A stream damaged in a few bytes, cut or prolonged.
fn damaged(stream: &[u8], dice: &mut Dice<'_>) -> Vec<u8> {
    let mut stream = stream.to_vec();
    for _ in 0..=dice.below(3) {
        let (at, byte) = (dice.below(stream.len()), dice.below(256) as u8);
        stream[at] = dice.pick(&[0, 1, 0x7f, 0x80, 0xfe, 0xff, byte]);
    }
    match dice.below(8) {
        0 => stream.truncate(1 + dice.below(stream.len())),
        1 => stream.push(0),
        _ => {}
    }
    stream
}

/// An element of `N` bytes.
#[derive(Clone, Copy)]
struct Element<const N: usize>([u8; N]);

impl<const N: usize> Default for Element<N> {
    fn default() -> Self {
        Self([0; N])
    }
}

/// Elements whose words are of one kind each: equal, near the one before as bytes, shorts or floats, or any.
fn elements<const N: usize>(count: usize, dice: &mut Dice<'_>) -> Vec<Element<N>> {
    let kinds: Vec<usize> = (0..N / 4).map(|_| dice.below(6)).collect();
    let reach = 1 + dice.below(40);
    let mut last = Element([0; N]);
    let step = |_| {
        for (word, kind) in last.0.as_chunks_mut::<4>().0.iter_mut().zip(&kinds) {
            let old = u32::from_le_bytes(*word);
            *word = match kind {
                0 => *word,
                1 => word.map(|byte| byte.wrapping_add(dice.below(reach) as u8)),
                2 => (old.wrapping_add(dice.below(reach) as u32) ^ (dice.below(reach) as u32) << 16)
                    .to_le_bytes(),
                3 => (old as f32 + dice.uniform()).to_le_bytes(),
                4 if !dice.one_in(20) => *word,
                _ => dice.word().to_le_bytes(),
            };
        }
        last
    };
    (0..count).map(step).collect()
}

fn compare_attributes<const N: usize>(dice: &mut Dice<'_>) {
    let theirs = |stream: &[u8], count: usize| -> Option<Vec<u8>> {
        let elements: Vec<Element<N>> = meshopt::decode_vertex_buffer(stream, count).ok()?;
        Some(elements.iter().flat_map(|element| element.0).collect())
    };
    for version in [0, 1] {
        let count = dice.pick(&[1, 2, 15, 16, 17, 31, 33, 100, 255, 256, 257, 300, 700]);
        let elements = elements::<N>(count, dice);
        let level = dice.below(4) as i32;
        let stream = meshopt::encode_vertex_buffer_level(&elements, level, Some(version)).unwrap();
        let view = View::attributes(N, count);
        let bytes: Vec<u8> = elements.iter().flat_map(|element| element.0).collect();
        assert!(view.decode(&stream) == Ok(bytes), "{view:?}, version {version}, level {level}");
        for _ in 0..20 {
            let stream = damaged(&stream, dice);
            // Damage may also make a stream of the other version, or one whose channel modes have unused
            // bits.
            match view.decode(&stream) {
                Ok(ours) => assert!(theirs(&stream, count) == Some(ours), "{view:?} {stream:?}"),
                Err(error) => assert!(
                    error.contains("the stream is broken") || error.contains("cannot hold"),
                    "{error}"
                ),
            }
        }
    }
}

#[test]
fn attributes_are_those_of_meshoptimizer() {
    let mut dice = Dice::from_seed(1);
    for _ in 0..10 {
        compare_attributes::<4>(&mut dice);
        compare_attributes::<8>(&mut dice);
        compare_attributes::<12>(&mut dice);
        compare_attributes::<16>(&mut dice);
        compare_attributes::<36>(&mut dice);
        compare_attributes::<64>(&mut dice);
        compare_attributes::<252>(&mut dice);
        compare_attributes::<256>(&mut dice);
    }
}

/// A triangle list: some rows of a grid, with triangles in the order of a cache, or of chance, and some
/// vertices replaced.
fn triangles(dice: &mut Dice<'_>) -> Vec<u32> {
    let side = 2 + dice.below(12) as u32;
    let corners = |cell: u32| {
        let a = cell / side * (side + 1) + cell % side;
        [a, a + 1, a + side + 1, a + side + 1, a + 1, a + side + 2]
    };
    let mut indices: Vec<u32> = (0..side * side).flat_map(corners).collect();
    if dice.one_in(2) {
        indices = meshopt::optimize_vertex_cache(&indices, ((side + 1) * (side + 1)) as usize);
    }
    for _ in 0..dice.below(6) {
        let (at, any) = (dice.below(indices.len()), dice.word() >> 4);
        indices[at] = dice.pick(&[0, 1, 70_000, 0x7fff_fffe, any]);
    }
    indices
}

#[test]
fn indices_are_those_of_meshoptimizer() {
    let mut dice = Dice::from_seed(2);
    for case in 0..150 {
        let indices = triangles(&mut dice);
        let count = indices.len();
        for mode in ["TRIANGLES", "INDICES"] {
            // Differences of a sequence have 30 bits.
            let indices: Vec<u32> = indices.iter().map(|index| index & 0x1fff_ffff).collect();
            let encode =
                if mode == "INDICES" { meshopt::encode_index_sequence } else { meshopt::encode_index_buffer };
            let stream = encode(&indices, 1 << 29).unwrap();
            let theirs = |stream: &[u8]| -> Option<Vec<u8>> {
                let decoded: Vec<u32> = if mode == "INDICES" {
                    meshopt::decode_index_sequence(stream, count).ok()?
                } else {
                    meshopt::decode_index_buffer(stream, count).ok()?
                };
                Some(decoded.into_iter().flat_map(u32::to_le_bytes).collect())
            };
            let [narrow, wide] = [2, 4].map(|stride| View::indices(mode, stride, count));
            let good = theirs(&stream).unwrap();
            let low: Vec<u8> = good.chunks(4).flat_map(|index| [index[0], index[1]]).collect();
            assert!(wide.decode(&stream) == Ok(good), "{case}: {wide:?}");
            assert!(narrow.decode(&stream) == Ok(low), "{case}: {narrow:?}");
            for _ in 0..20 {
                let stream = damaged(&stream, &mut dice);
                if let Ok(ours) = wide.decode(&stream) {
                    assert!(theirs(&stream) == Some(ours), "{wide:?} {stream:?}");
                }
            }
        }
    }
}

/// What ours and theirs make of elements of four bytes or shorts.
fn filtered(filter: &'static str, words: &[[i16; 4]], is_wide: bool) -> [Vec<i32>; 2] {
    let view = |stride| View { filter, ..View::attributes(stride, words.len()) };
    let is_signed = filter != "COLOR";
    if is_wide {
        let data: Vec<Element<8>> =
            words.iter().map(|word| Element(bytemuck::cast(word.map(i16::to_le)))).collect();
        let ours = view(8).decode(&meshopt::encode_vertex_buffer(&data).unwrap()).unwrap();
        let mut theirs = words.to_vec();
        match filter {
            "OCTAHEDRAL" => meshopt::decode_filter_oct::<i16>(&mut theirs),
            "QUATERNION" => meshopt::decode_filter_quat(&mut theirs),
            _ => meshopt::decode_filter_color::<i16>(&mut theirs),
        }
        let number = |short: i16| if is_signed { i32::from(short) } else { i32::from(short as u16) };
        let ours = ours.chunks(2).map(|bytes| number(i16::from_le_bytes([bytes[0], bytes[1]]))).collect();
        [ours, theirs.into_flattened().into_iter().map(number).collect()]
    } else {
        let mut theirs: Vec<[u8; 4]> = words.iter().map(|word| word.map(|value| value as u8)).collect();
        let data: Vec<Element<4>> = theirs.iter().map(|&word| Element(word)).collect();
        let ours = view(4).decode(&meshopt::encode_vertex_buffer(&data).unwrap()).unwrap();
        match filter {
            "OCTAHEDRAL" => meshopt::decode_filter_oct(&mut theirs),
            _ => meshopt::decode_filter_color(&mut theirs),
        }
        let number = |byte: u8| if is_signed { i32::from(byte as i8) } else { i32::from(byte) };
        [ours.into_iter().map(number).collect(), theirs.into_flattened().into_iter().map(number).collect()]
    }
}

/// Compares a filter on valid elements. On processors for which meshoptimizer has SIMD code, the results are
/// equal where `is_exact`; elsewhere they may differ by the one unit that the specification permits.
fn compare_filter(filter: &'static str, words: &[[i16; 4]], is_wide: bool, is_exact: bool) {
    let [ours, theirs] = filtered(filter, words, is_wide);
    let permitted = i32::from(!is_exact || !cfg!(target_arch = "x86_64"));
    for (i, (a, b)) in ours.iter().zip(&theirs).enumerate() {
        let (word, at) = (words[i / 4], i % 4);
        assert!((a - b).abs() <= permitted, "{filter} of {word:?}, component {at}: {a} is not {b}");
    }
}

/// Integers of `bits` bits.
fn signed(bits: u32, dice: &mut Dice<'_>) -> i16 {
    let max = (1 << (bits - 1)) - 1;
    ((dice.word() % (2 * max + 1)) as i32 - max as i32) as i16
}

#[test]
fn filtered_vectors_are_those_of_meshoptimizer() {
    let mut dice = Dice::from_seed(3);
    for bits in 2..=16 {
        let one = ((1i32 << (bits - 1)) - 1) as i16;
        let mut word = || [signed(bits, &mut dice), signed(bits, &mut dice), one, signed(8, &mut dice)];
        let words: Vec<[i16; 4]> = (0..20_000).map(|_| word()).collect();
        compare_filter("OCTAHEDRAL", &words, true, true);
        if bits <= 8 {
            // meshoptimizer takes an approximate root.
            compare_filter("OCTAHEDRAL", &words, false, false);
        }
    }
}

#[test]
fn filtered_quaternions_are_those_of_meshoptimizer() {
    let mut dice = Dice::from_seed(4);
    for bits in 4..=16 {
        let one = ((1i32 << (bits - 1)) - 1) as i16;
        let mut word = || {
            // The three smaller components of a unit quaternion: their squares sum up to three quarters at
            // most.
            let mut small = || (f32::from(signed(bits, &mut dice)) * 0.57) as i16;
            let vector = [small(), small(), small()];
            [vector[0], vector[1], vector[2], one & !3 | dice.below(4) as i16]
        };
        let words: Vec<[i16; 4]> = (0..20_000).map(|_| word()).collect();
        compare_filter("QUATERNION", &words, true, true);
    }
}

#[test]
fn filtered_colors_are_those_of_meshoptimizer() {
    let mut dice = Dice::from_seed(5);
    for bits in 2..=16 {
        let mut word = || {
            let [r, g, b, a] = [(); 4].map(|()| (dice.word() % (1 << bits)) as i32);
            // YCoCg of integers; the bit above alpha's others is that of the scale.
            let co = (r - b) / 2;
            let cg = (g - b - co) / 2;
            [b + co + cg, co, cg, a >> 1 | 1 << (bits - 1)].map(|value| value as i16)
        };
        let words: Vec<[i16; 4]> = (0..20_000).map(|_| word()).collect();
        compare_filter("COLOR", &words, true, true);
        if bits <= 8 {
            // meshoptimizer takes an approximate quotient.
            compare_filter("COLOR", &words, false, false);
        }
    }
}

/// Every exponent with mantissas of all sizes, bit for bit.
#[test]
fn exponential_floats_are_those_of_meshoptimizer() {
    let mut dice = Dice::from_seed(6);
    let mantissas = [0, 1, 2, 3, 0x7f_ffff, 0x80_0000, 0x80_0001, 0xff_ffff];
    let mut words = Vec::new();
    for exponent in -100i32..=100 {
        let any = (0..50).map(|_| dice.word() & 0xff_ffff).collect::<Vec<_>>();
        words.extend(mantissas.iter().chain(&any).map(|mantissa| [(exponent as u32) << 24 | mantissa]));
    }
    let data: Vec<Element<4>> = words.iter().map(|[word]| Element(word.to_le_bytes())).collect();
    let view = View { filter: "EXPONENTIAL", ..View::attributes(4, data.len()) };
    let ours = view.decode(&meshopt::encode_vertex_buffer(&data).unwrap()).unwrap();
    meshopt::decode_filter_exp(&mut words);
    let theirs: Vec<u8> = words.iter().flat_map(|[word]| word.to_le_bytes()).collect();
    assert!(ours == theirs);
}

/// Combinations of mode, filter and stride that the specification does not have.
#[test]
fn other_combinations_are_refused() {
    let stream = meshopt::encode_vertex_buffer(&elements::<12>(3, &mut Dice::from_seed(7))).unwrap();
    let view = View::attributes(12, 3);
    view.decode(&stream).unwrap();
    let combinations = [
        View { filter: "OCTAHEDRAL", ..view },
        View { filter: "QUATERNION", ..view },
        View { filter: "COLOR", ..view },
        View { filter: "ODD", ..view },
        View { mode: "ODD", ..view },
        View { mode: "TRIANGLES", ..view },
        View { mode: "TRIANGLES", filter: "EXPONENTIAL", stride: 4, count: 9 },
        View { stride: 6, count: 6, ..view },
        View { stride: 0, count: 0, ..view },
        View { stride: 260, ..view },
    ];
    for wrong in combinations {
        let error = wrong.decode(&stream).unwrap_err();
        assert!(error.starts_with("x.gltf: bufferViews[0]"), "{wrong:?}: {error}");
    }
}

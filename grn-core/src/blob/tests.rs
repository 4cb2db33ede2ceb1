use super::*;
use crate::motif::{MAX_INPUTS, Motif};
use crate::network::{Gene, NetworkError, Source};
use proptest::prelude::*;
use std::vec::Vec;

fn gene(motif: Motif, inputs: &[Source], theta: f32) -> Gene<f32> {
    Gene { motif, inputs: inputs.iter().copied().collect(), theta }
}

fn around<const N: usize>(network: Network<f32, N>) -> Blob<N> {
    Blob {
        network,
        field: FieldParameters { kernel: Kernel::Gaussian, target_width: 1.5, obstacle_width: 0.9 },
        level_fraction: 0.5,
        scale: 0.25,
        step: Step::EIGHTH,
        time_scale: 4.0,
        gains: Gains::default(),
    }
}

fn printed() -> Blob {
    let nand = gene(Motif::Nand, &[Source::X1, Source::X1], 0.8393);
    let xnor = gene(Motif::Xnor, &[Source::Gene(0), Source::X2], 0.9256);
    around(Network::new(1.0, [nand, xnor]).unwrap())
}

fn bytes_of<const N: usize>(blob: &Blob<N>) -> Vec<u8> {
    blob.encode(&mut std::vec![0; max_encoded_size(N)]).unwrap().to_vec()
}

/// A valid envelope around any payload.
fn sealed(payload: &[u8]) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    bytes.push(FORMAT_VERSION);
    bytes.extend((payload.len() as u16).to_le_bytes());
    bytes.extend(identity_of(payload));
    bytes.extend(payload);
    bytes.extend(CRC.checksum(&bytes).to_le_bytes());
    bytes
}

fn payload_of(bytes: &[u8]) -> &[u8] {
    &bytes[HEADER..bytes.len() - CRC_BYTES]
}

#[test]
fn the_printed_two_gene_model_fits_in_96_bytes() {
    let bytes = bytes_of(&printed());
    assert!(bytes.len() <= 96, "{} bytes", bytes.len());
    let back = Blob::<32>::decode(&bytes).unwrap();
    assert_eq!(back, printed());
    assert_eq!(back.identity(), bytes[7..15]);
}

#[test]
fn each_fault_of_the_envelope_is_named() {
    let good = bytes_of(&printed());
    let decode = |bytes: &[u8]| Blob::<32>::decode(bytes).unwrap_err();
    let changed = |at: usize, value: u8| {
        let mut bytes = good.clone();
        bytes[at] = value;
        bytes
    };
    assert_eq!(decode(&[]), BlobError::Truncated);
    assert_eq!(decode(&good[..10]), BlobError::Truncated);
    assert!(matches!(decode(&good[..40]), BlobError::Length { found: 40, .. }));
    assert!(matches!(decode(&[&good[..], &[0]].concat()), BlobError::Length { .. }));
    assert!(matches!(decode(&changed(0, b'X')), BlobError::NotABlob { .. }));
    assert_eq!(decode(&changed(4, 2)), BlobError::Version { found: 2 });
    assert_eq!(decode(&changed(4, 0)), BlobError::Version { found: 0 });
    assert!(matches!(decode(&changed(30, 0x55)), BlobError::Crc { .. }));
    let mut forged = changed(8, good[8] ^ 1);
    let body = forged.len() - CRC_BYTES;
    let crc = CRC.checksum(&forged[..body]);
    forged[body..].copy_from_slice(&crc.to_le_bytes());
    assert_eq!(decode(&forged), BlobError::Identity);
}

#[test]
fn each_fault_of_the_payload_is_named() {
    let good = bytes_of(&printed());
    let with = |at: usize, replacement: &[u8]| {
        let mut payload = payload_of(&good).to_vec();
        payload.splice(at..at + 1, replacement.iter().copied());
        Blob::<32>::decode(&sealed(&payload)).unwrap_err()
    };
    // Offsets: 0 convention, 1 gene count, 2 opcode, 3 input count, 4..6 inputs, 6..10 θ, 10 second gene ...
    assert_eq!(with(0, &[9]), BlobError::Convention(9));
    assert_eq!(with(2, &[11]), BlobError::Opcode { gene: 0, opcode: 11 });
    let arity = NetworkError::Arity { gene: 0, motif: Motif::Pos, inputs: 2 };
    assert_eq!(with(2, &[Motif::Pos.code()]), BlobError::Network(arity));
    assert_eq!(with(4, &[2]), BlobError::Network(NetworkError::NotFeedForward { gene: 0, reads: 0 }));
    assert!(matches!(with(9, &[0x7f]), BlobError::Network(NetworkError::Theta { gene: 0, .. })));
    assert_eq!(with(22, &[3]), BlobError::Kernel(3));
    assert_eq!(with(39, &[11]), BlobError::Step(crate::dynamics::StepError(11)));
    assert_eq!(with(1, &[33]), BlobError::Network(NetworkError::TooManyGenes { genes: 33, capacity: 32 }));
    // An over-long varint for the gene count, and bytes behind the last field.
    assert_eq!(with(1, &[0x82, 0x00]), BlobError::NotCanonical);
    let last = payload_of(&good).len() - 1;
    assert_eq!(with(last, &[payload_of(&good)[last], 7]), BlobError::NotCanonical);
    // NaN for the level fraction.
    assert!(matches!(with(34, &[0xff]), BlobError::Parameter { name: "level_fraction", .. }));
}

#[test]
fn a_smaller_robot_refuses_a_larger_network() {
    let bytes = bytes_of(&printed());
    let refused = Blob::<1>::decode(&bytes).unwrap_err();
    assert_eq!(refused, BlobError::Network(NetworkError::TooManyGenes { genes: 2, capacity: 1 }));
}

#[test]
fn parameters_out_of_range_are_not_written() {
    let spoils: [fn(&mut Blob); 3] = [|b| b.scale = 0.0, |b| b.gains.turn = f32::NAN, |b| b.field.target_width = 1e9];
    for spoil in spoils {
        let mut blob = printed();
        spoil(&mut blob);
        assert!(matches!(blob.encode(&mut [0; 512]), Err(BlobError::Parameter { .. })));
    }
    assert_eq!(printed().encode(&mut [0; 90]), Err(BlobError::BufferTooSmall { capacity: 90 }));
}

prop_compose! {
    fn any_gene(index: usize)(
        motif in 0..10_usize,
        extra in 0..3_usize,
        sources in prop::collection::vec(0..2 + index as u8, MAX_INPUTS),
        theta in 0.0..=2.0_f32,
    ) -> Gene<f32> {
        let motif = Motif::ALL[motif];
        let inputs = (*motif.arity().start() + extra).min(*motif.arity().end());
        gene(motif, &sources[..inputs].iter().map(|&c| Source::from_code(c)).collect::<Vec<_>>(), theta)
    }
}

fn any_blob() -> impl Strategy<Value = Blob> {
    (1..=32_usize)
        .prop_flat_map(|genes| (0..genes).map(any_gene).collect::<Vec<_>>())
        .prop_map(|genes| around(Network::new(1.0, genes).unwrap()))
}

proptest! {
    #[test]
    fn every_blob_survives_the_round_trip(blob in any_blob()) {
        let bytes = bytes_of(&blob);
        prop_assert!(bytes.len() <= max_encoded_size(blob.network.genes().len()));
        prop_assert_eq!(Blob::decode(&bytes), Ok(blob));
    }

    #[test]
    fn a_mutated_payload_is_refused_or_canonical(blob in any_blob(), at in any::<prop::sample::Index>(), byte: u8) {
        let bytes = bytes_of(&blob);
        let mut payload = payload_of(&bytes).to_vec();
        let at = at.index(payload.len());
        payload[at] = byte;
        let mutated = sealed(&payload);
        if let Ok(accepted) = Blob::<32>::decode(&mutated) {
            prop_assert_eq!(bytes_of(&accepted), mutated);
        }
    }

    #[test]
    fn any_flipped_bit_is_noticed(blob in any_blob(), at in any::<prop::sample::Index>(), bit in 0..8_u32) {
        let mut bytes = bytes_of(&blob);
        let at = at.index(bytes.len());
        bytes[at] ^= 1_u8 << bit;
        prop_assert!(Blob::<32>::decode(&bytes).is_err());
    }
}

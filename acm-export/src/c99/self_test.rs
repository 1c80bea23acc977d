//! Recorded vectors at the end of the source, compiled with `-DSELFTEST` only.

use super::text::{double, rows};
use crate::rehearsal::{Answer, Sample, rms};

const MAIN: &str = include_str!("runtime/self_test.c");

/// Returns the vectors and a `main` that compares them.
pub fn write(outputs: usize, samples: &[Sample], answers: &[Answer]) -> String {
    let inputs: Vec<Vec<String>> = samples
        .iter()
        .map(|sample| {
            let known = [sample.elapsed, f64::from(u8::from(sample.seen))];
            known.iter().chain(&sample.inputs).map(|value| double(*value)).collect()
        })
        .collect();
    let expected: Vec<Vec<String>> = answers
        .iter()
        .map(|answer| answer.tip.iter().chain(&answer.nominal).map(|value| double(*value)).collect())
        .collect();
    let sizes: Vec<Vec<String>> = rms(answers).iter().map(|size| vec![double(size.max(f64::MIN_POSITIVE))]).collect();
    let outside = answers.iter().filter(|answer| answer.in_range == Some(false)).count();
    format!(
        "\n#ifdef SELFTEST\n#include <stdio.h>\n\n#define RECORDED {}\n#define OUTSIDE {outside} /* samples out of the training range */\n\
         /* Time since the sample before, whether the network sees it, inputs. */\n{}\
         /* Answers of acm-stream: outputs, then those of the nominal model alone. */\n{}\
         /* Root mean square of each output. */\n{}\n{MAIN}#endif\n",
        samples.len(),
        rows("double", "SAMPLE", &inputs),
        rows("double", "ANSWER", &expected),
        rows("double", "SIZE", &sizes),
    )
    .replace("@COUNT", &outputs.to_string())
}

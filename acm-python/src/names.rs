//! Names of trials in a column of a frame.

use polars_arrow::array::{Array, DictionaryArray, DictionaryKey, PrimitiveArray, Utf8Array, Utf8ViewArray};

use crate::arrow::Taken;

/// Each name once, in order of appearance; none where the column is not there or holds no names.
pub fn of(taken: &Taken, column: &str) -> Option<Vec<String>> {
    let at = taken.schema.get_full(column)?.0;
    let mut names: Vec<String> = vec![];
    for batch in &taken.batches {
        let mut last: Option<String> = None;
        for name in texts(batch.arrays()[at].as_ref())?.into_iter().flatten() {
            if last.as_ref() != Some(&name) && !names.contains(&name) {
                names.push(name.clone());
            }
            last = Some(name);
        }
    }
    Some(names)
}

/// Cells as text.
fn texts(array: &dyn Array) -> Option<Vec<Option<String>>> {
    let any = array.as_any();
    let owned = |text: Option<&str>| text.map(str::to_string);
    if let Some(array) = any.downcast_ref::<Utf8ViewArray>() {
        return Some(array.iter().map(owned).collect());
    }
    if let Some(array) = any.downcast_ref::<Utf8Array<i64>>() {
        return Some(array.iter().map(owned).collect());
    }
    if let Some(array) = any.downcast_ref::<Utf8Array<i32>>() {
        return Some(array.iter().map(owned).collect());
    }
    if let Some(array) = any.downcast_ref::<PrimitiveArray<i64>>() {
        return Some(array.iter().map(|value| value.map(ToString::to_string)).collect());
    }
    categories::<i8>(array)
        .or_else(|| categories::<i16>(array))
        .or_else(|| categories::<i32>(array))
        .or_else(|| categories::<u8>(array))
        .or_else(|| categories::<u16>(array))
        .or_else(|| categories::<u32>(array))
}

fn categories<K: DictionaryKey>(array: &dyn Array) -> Option<Vec<Option<String>>> {
    let array = array.as_any().downcast_ref::<DictionaryArray<K>>()?;
    let values = texts(array.values().as_ref())?;
    Some(array.keys_iter().map(|key| key.and_then(|key| values.get(key).cloned().flatten())).collect())
}

/// Rows at which another name stands than in the row before, the first among them.
pub fn starts(taken: &Taken, column: &str) -> Option<Vec<usize>> {
    let at = taken.schema.get_full(column)?.0;
    let (mut starts, mut row, mut last) = (vec![], 0, None);
    for batch in &taken.batches {
        for name in texts(batch.arrays()[at].as_ref())? {
            if row == 0 || last != name {
                starts.push(row);
                last = name;
            }
            row += 1;
        }
    }
    Some(starts)
}

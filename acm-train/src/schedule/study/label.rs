//! Labels of a sweep's settings.

use toml::Value;

use super::sweep::Setting;

/// Writes `length=25 units=16`: the last part of each key with its value.
pub fn label(setting: &Setting) -> String {
    let part = |(key, value): &(String, Value)| {
        let text = value.as_str().map_or_else(|| value.to_string(), String::from);
        format!("{}={text}", key.rsplit('.').next().unwrap_or(key))
    };
    setting.iter().map(part).collect::<Vec<_>>().join(" ")
}

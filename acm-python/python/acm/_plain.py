"""Objects of Python as JSON knows them."""

import os


def plain(value):
    """Dictionaries, lists, texts, numbers and truth values; paths become text, arrays and tuples lists."""
    if isinstance(value, dict):
        return {str(key): plain(member) for key, member in value.items()}
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, (list, tuple, set)):
        return [plain(member) for member in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    raise TypeError(f"{value!r} has no form in a TOML file; give texts, numbers, lists and dictionaries")

"""Case files."""
import pathlib
import tomllib

from .tables import existing


def flat(table, prefix=""):
    """Dotted keys of nested tables, "rag.0.radius_m" of the first [[rag]]."""
    keys = {}
    for key, value in table.items():
        name = prefix + key
        if isinstance(value, dict):
            keys |= flat(value, name + ".")
        elif isinstance(value, list) and value and all(isinstance(one, dict) for one in value):
            for i, one in enumerate(value):
                keys |= flat(one, f"{name}.{i}.")
        else:
            keys[name] = value
    return keys


class Case:
    """A case file as it is written: case["time.end_s"], case["rag.0.radius_m"]. The case.resolved.toml of a run has every key, in SI."""

    def __init__(self, file):
        self.file = existing(file, "you, or of a run snag as case.resolved.toml,")
        self.tables = tomllib.loads(self.file.read_text())
        self.keys = flat(self.tables)

    def __getitem__(self, key):
        if key not in self.keys:
            last = key.rpartition(".")[2]
            near = [name for name in self.keys if name.rpartition(".")[2].startswith(last)]
            raise KeyError(f"{self.file} has no {key}" + (f"; it has {', '.join(near[:5])}" if near else ""))
        return self.keys[key]

    def __contains__(self, key):
        return key in self.keys

    def difference(self, other):
        """Keys whose values differ, as a data frame with the values of both; None where a case lacks the key."""
        import pandas

        names = [key for key in {**self.keys, **other.keys} if self.keys.get(key) != other.keys.get(key)]
        rows = {"this": [self.keys.get(key) for key in names], "other": [other.keys.get(key) for key in names]}
        return pandas.DataFrame(rows, index=pandas.Index(names, name="key"), dtype=object)

    def __repr__(self):
        return f"Case({str(pathlib.Path(self.file))!r}): {len(self.keys)} keys"

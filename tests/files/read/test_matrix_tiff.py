"""Every kind of TIFF is read as it is meant: by what was written, and by two other readers."""

import struct
from dataclasses import dataclass

import numpy as np
import pytest

from stippler.files.read.picture import read_darkness, size_of_picture

WHITE_IS_ZERO, BLACK_IS_ZERO, RGB, PALETTE, MASK, CMYK, YCBCR, _, CIELAB = range(9)
UINT, INT, FLOAT = 1, 2, 3
H, W = 6, 8


def scene():
    """A picture without symmetry, RGBA in 0..1."""
    y, x = np.mgrid[0 : 1 : H * 1j, 0 : 1 : W * 1j]
    rgb = np.stack([x, 0.2 + 0.6 * y, 0.5 + 0.5 * x * y], axis=2)
    alpha = np.clip(0.3 + 0.7 * (1 - x) + 0.2 * y, 0, 1)
    alpha[0, 0], alpha[1, 3] = 0, 1
    return np.concatenate([rgb, alpha[..., None]], axis=2)


SCENE = scene()


def to_linear(v):
    return np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def darkness(rgba):
    """Darkness over white of encoded RGBA."""
    return (1 - to_linear(np.clip(rgba[..., :3], 0, 1)) @ [0.2126, 0.7152, 0.0722]) * rgba[..., 3]


# --- a writer of our own, for what no library writes ---------------------------------------------


@dataclass(frozen=True)
class Case:
    """One TIFF without compression, and what it means."""

    name: str
    photometric: int
    bits: int = 8
    form: int = UINT
    extra: tuple = ()
    planar: int = 1
    orientation: int = 1
    order: str = "<"
    big: bool = False
    fill: int = 1
    rows: int = 4

    def samples(self) -> np.ndarray:
        """Return the samples as numbers from 0 to 1, (h, w, channels)."""
        rgba = SCENE
        if self.photometric in (WHITE_IS_ZERO, BLACK_IS_ZERO):
            colours = rgba[..., :1]
        elif self.photometric == RGB:
            colours = rgba[..., :3]
        elif self.photometric == CMYK:
            colours = np.concatenate([1 - rgba[..., :3], 0.25 * rgba[..., :1]], axis=2)
        else:
            raise AssertionError(self.photometric)
        if self.photometric == WHITE_IS_ZERO:
            colours = 1 - colours
        parts = [colours]
        for kind in self.extra:
            parts.append(rgba[..., 3:])
            if kind == 1:
                parts[0] = colours * rgba[..., 3:]
        return np.concatenate(parts, axis=2)

    def numbers(self) -> np.ndarray:
        """Return what stands in the file."""
        unit = self.samples()
        if self.form == FLOAT:
            return unit.astype(f"f{self.bits // 8}")
        top = 2 ** (self.bits - (self.form == INT)) - 1
        if self.bits == 64:
            return (unit * 2.0**63).astype(np.uint64) * np.uint64(2) - (unit > 0.999)
        return np.rint(unit * float(top)).astype(np.int64)

    def meaning(self) -> np.ndarray:
        """Return the upright RGBA that the file's numbers stand for."""
        numbers = self.numbers().astype(np.float64)
        top = 1 if self.form == FLOAT else float(2 ** (self.bits - (self.form == INT)) - 1)
        unit = numbers / top
        n = {WHITE_IS_ZERO: 1, BLACK_IS_ZERO: 1, RGB: 3, CMYK: 4}[self.photometric]
        colours, alpha = unit[..., :n], np.ones((H, W, 1))
        if self.extra and (self.extra[0] in (1, 2) or len(self.extra) == 1):
            alpha = unit[..., n : n + 1]
            if self.extra[0] == 1:
                colours = np.clip(colours / np.where(alpha > 0, alpha, 1), 0, 1)
        if self.photometric == WHITE_IS_ZERO:
            colours = 1 - colours
        if self.photometric == CMYK:
            colours = (1 - colours[..., :3]) * (1 - colours[..., 3:])
        rgba = np.concatenate([np.broadcast_to(colours, (H, W, 3)), alpha], axis=2)
        return turned(rgba, self.orientation)


def turned(field, orientation):
    """Turn stored rows and columns upright, as the TIFF specification tells it (page 36)."""
    field = np.swapaxes(field, 0, 1) if orientation >= 5 else field
    rows_up, columns_left = orientation in (3, 4, 7, 8), orientation in (2, 3, 6, 7)
    field = field[::-1] if rows_up else field
    return field[:, ::-1] if columns_left else field


def packed(numbers, case):
    """Return rows of samples as bytes."""
    if case.form == FLOAT or case.bits in (8, 16, 32, 64):
        letter = {UINT: "u", INT: "i", FLOAT: "f"}[case.form]
        kind = f"{case.order}{letter}{case.bits // 8}"
        return [row.astype(kind).tobytes() for row in numbers.reshape(len(numbers), -1)]
    rows = []
    for row in numbers.reshape(len(numbers), -1):
        if case.bits % 8 == 0:
            order = "little" if case.order == "<" else "big"
            rows.append(b"".join(int(v).to_bytes(case.bits // 8, order) for v in row))
            continue
        text = "".join(format(int(v), f"0{case.bits}b") for v in row)
        text += "0" * (-len(text) % 8)
        if case.fill == 2:
            text = "".join(text[k : k + 8][::-1] for k in range(0, len(text), 8))
        rows.append(bytes(int(text[k : k + 8], 2) for k in range(0, len(text), 8)))
    return rows


def written(case, tags=(), numbers=None):
    """Return a whole file."""
    numbers = case.numbers() if numbers is None else numbers
    h, w, channels = numbers.shape
    planes = [numbers] if case.planar == 1 else [numbers[..., k : k + 1] for k in range(channels)]
    strips = []
    for plane in planes:
        rows = packed(plane, case)
        strips += [b"".join(rows[k : k + case.rows]) for k in range(0, h, case.rows)]
    short, long = ("H", 3), ("I", 4)
    entries = {
        256: (long, [w]), 257: (long, [h]), 258: (short, [case.bits] * channels),
        259: (short, [1]), 262: (short, [case.photometric]), 266: (short, [case.fill]),
        274: (short, [case.orientation]), 277: (short, [channels]), 278: (long, [case.rows]),
        279: (long, [len(s) for s in strips]), 284: (short, [case.planar]),
        339: (short, [case.form] * channels), 273: (long, [0] * len(strips)),
    }  # fmt: skip
    if case.extra:
        entries[338] = (short, list(case.extra))
    entries.update(tags)
    o = case.order
    head = (b"II" if o == "<" else b"MM") + (
        struct.pack(f"{o}HHHQ", 43, 8, 0, 16) if case.big else struct.pack(f"{o}HI", 42, 8)
    )
    count, inline, place = ("Q", 8, "Q") if case.big else ("H", 4, "I")
    size = struct.calcsize(f"{o}{count}") + len(entries) * (12 if not case.big else 20) + inline
    after, blocks = len(head) + size, {}
    for code, ((letter, _kind), values) in sorted(entries.items()):
        if struct.calcsize(letter) * len(values) > inline:
            blocks[code] = after
            after += struct.calcsize(letter) * len(values)
    starts = []
    for strip in strips:
        starts.append(after)
        after += len(strip)
    entries[273] = (long, starts)
    directory, out = struct.pack(f"{o}{count}", len(entries)), b""
    for code, ((letter, kind), values) in sorted(entries.items()):
        data = struct.pack(f"{o}{len(values)}{letter}", *values)
        directory += struct.pack(f"{o}HH{place}", code, kind, len(values))
        if code in blocks:
            directory += struct.pack(f"{o}{place}", blocks[code])
            out += data
        else:
            directory += data.ljust(inline, b"\0")
    return head + directory + bytes(inline) + out + b"".join(strips)


# --- the matrix ---------------------------------------------------------------------------------

PHOTOMETRICS = {"white-is-zero": WHITE_IS_ZERO, "black-is-zero": BLACK_IS_ZERO, "rgb": RGB}


def cases():
    deep = [(b, UINT) for b in (1, 2, 4, 8, 10, 12, 14, 16, 24, 32, 64)]
    deep += [(b, INT) for b in (8, 16, 32)] + [(b, FLOAT) for b in (16, 32, 64)]
    names = {UINT: "uint", INT: "int", FLOAT: "float"}
    for kind, photometric in PHOTOMETRICS.items():
        for bits, form in deep:
            if photometric == RGB and bits < 4:
                continue
            yield Case(f"{kind}-{names[form]}{bits}", photometric, bits, form)
    for kind, photometric in (*PHOTOMETRICS.items(), ("cmyk", CMYK)):
        for bits, form in ((8, UINT), (16, UINT), (32, FLOAT)):
            for extra in ((0,), (1,), (2,), (2, 0)):
                if photometric == CMYK and form == FLOAT:
                    continue
                name = f"{kind}-{names[form]}{bits}-extra{''.join(map(str, extra))}"
                yield Case(name, photometric, bits, form, extra=extra)
    for bits, form in ((8, UINT), (12, UINT), (16, UINT), (32, FLOAT), (64, FLOAT)):
        yield Case(f"rgb-planar-{names[form]}{bits}", RGB, bits, form, planar=2)
        yield Case(f"rgba-planar-{names[form]}{bits}", RGB, bits, form, planar=2, extra=(2,))
    for orientation in range(1, 9):
        for kind, photometric in PHOTOMETRICS.items():
            for bits in (8, 16):
                name = f"{kind}-{bits}-turned{orientation}"
                yield Case(name, photometric, bits, orientation=orientation)
    for bits, form in ((4, UINT), (10, UINT), (12, UINT), (16, UINT), (24, UINT), (32, UINT),
                       (16, INT), (16, FLOAT), (32, FLOAT), (64, FLOAT)):  # fmt: skip
        for big in (False, True):
            name = f"motorola-{names[form]}{bits}{'-big' if big else ''}"
            yield Case(name, BLACK_IS_ZERO, bits, form, order=">", big=big)
    for bits in (1, 4):
        for photometric in (WHITE_IS_ZERO, BLACK_IS_ZERO):
            yield Case(f"reversed-bits-{bits}-{photometric}", photometric, bits, fill=2)
    for bits in (8, 16):
        yield Case(f"cmyk-{bits}", CMYK, bits)
        yield Case(f"cmyk-planar-{bits}", CMYK, bits, planar=2)


CASES = list(cases())


def excuse(judge, case):
    """Return why a judge is known to see something else than the specification says, if it is."""
    turns = case.photometric == WHITE_IS_ZERO
    if judge == "ImageMagick":
        if case.form == INT:
            return "moves signed numbers so that 0 is in the middle"
        if turns and (case.form == FLOAT or case.bits not in (1, 8, 16, 24, 64) or case.extra):
            return "turns white-is-zero only without alpha, in 8 and 16 bits"
        if case.bits == 24:
            return "takes them for floats"
        if case.extra == (2, 0) and case.photometric == BLACK_IS_ZERO:
            return "takes the second extra channel of grey"
    if judge == "libvips":
        if turns and (case.form != UINT or case.extra):
            return "turns nothing but integers, and alpha with them"
        if case.form == FLOAT and 1 in case.extra:
            return "divides floats by 255"
    return ""


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_numbers_mean_what_the_specification_says(tmp_path, judges, case):
    path = tmp_path / "picture.tif"
    path.write_bytes(written(case))
    want = darkness(case.meaning())
    assert size_of_picture(path) == (want.shape[1], want.shape[0])
    np.testing.assert_allclose(read_darkness(path), want, atol=1e-4)
    premultiplied = 1 in case.extra and case.bits == 8  # judges round when they divide
    for name, judge in judges.items():
        seen = judge(path)
        if seen is None or excuse(name, case):
            continue
        assert seen.shape == (*want.shape, 4), name
        np.testing.assert_allclose(
            darkness(seen), want, atol=8e-3 if premultiplied else 1e-3, err_msg=name
        )


def test_the_matrix_is_judged(tmp_path, judges):
    """All but a few kinds, which neither of the two can read, are confirmed by one at least."""
    alone = []
    for case in CASES:
        (tmp_path / "picture.tif").write_bytes(written(case))
        if all(excuse(n, case) or j(tmp_path / "picture.tif") is None for n, j in judges.items()):
            alone.append(case.name)
    assert len(CASES) >= 150
    assert len(alone) <= len(CASES) // 8, alone

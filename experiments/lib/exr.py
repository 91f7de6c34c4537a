"""Reads the EXR files that troffer writes: scan lines, 32-bit float, ZIP, layers by name.

Other EXR files are refused. The format: openexr.com, "OpenEXR File Layout".
"""

import struct
import zlib

import numpy as np

ZIP_COMPRESSION = 3
LINES_PER_BLOCK = 16
FLOAT = 2


def _attributes(data):
    """Returns the header attributes as {name: bytes}, and the offset after the header."""
    magic, version = struct.unpack_from("<II", data, 0)
    if magic != 20000630 or version & ~0x400 != 2:
        raise ValueError("not a single-part scan line EXR file")
    at, attributes = 8, {}
    while data[at] != 0:
        name_end = data.index(b"\0", at)
        type_end = data.index(b"\0", name_end + 1)
        size = struct.unpack_from("<i", data, type_end + 1)[0]
        start = type_end + 5
        attributes[data[at:name_end].decode()] = data[start : start + size]
        at = start + size
    return attributes, at + 1


def _channels(chlist):
    names, at = [], 0
    while chlist[at] != 0:
        end = chlist.index(b"\0", at)
        if struct.unpack_from("<i", chlist, end + 1)[0] != FLOAT:
            raise ValueError("a channel is not 32-bit float")
        names.append(chlist[at:end].decode())
        at = end + 17
    return names


def _inflate(block, size):
    if len(block) == size:  # stored uncompressed if compression does not pay
        return block
    coded = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    coded[1:] -= 128
    bytes_ = np.cumsum(coded).astype(np.uint8)
    out = np.empty(size, np.uint8)
    half = (size + 1) // 2
    out[0::2], out[1::2] = bytes_[:half], bytes_[half:]
    return out.tobytes()


def read(path):
    """Returns {layer: float32 array (height, width, channels)}; "" is the picture, channels as named."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = _attributes(data)
    if attributes["compression"][0] != ZIP_COMPRESSION:
        raise ValueError(f"{path}: compression is not ZIP")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    names = _channels(attributes["channels"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    blocks = (height + LINES_PER_BLOCK - 1) // LINES_PER_BLOCK
    planes = np.empty((height, len(names), width), np.float32)
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        lines = min(LINES_PER_BLOCK, y1 - y + 1)
        raw = _inflate(data[offset + 8 : offset + 8 + size], lines * len(names) * width * 4)
        shape = (lines, len(names), width)
        planes[y - y0 : y - y0 + lines] = np.frombuffer(raw, "<f4").reshape(shape)
    return _layers(names, planes)


def _layers(names, planes):
    groups = {}
    for i, name in enumerate(names):
        layer, _, channel = name.rpartition(".")
        groups.setdefault(layer, {})[channel] = planes[:, i, :]
    return {
        layer: np.stack([c[k] for k in sorted(c, key="RGBXYZV".index)], axis=-1)
        for layer, c in groups.items()
    }

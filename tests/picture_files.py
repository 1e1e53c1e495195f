"""OpenEXR, PNG and PFM, read and written without the program: as far as pictures_test.py needs them."""
import struct
import zlib
from pathlib import Path

SIZE = {"half": (2, "e"), "float": (4, "f"), "uint": (4, "I")}


def header_of(data):
    """Attributes of an OpenEXR file by name, and where they end."""
    assert data[:4] == b"\x76\x2f\x31\x01"
    at, attributes = 8, {}

    def word():
        nonlocal at
        end = data.index(b"\0", at)
        text, at = data[at:end].decode(), end + 1
        return text
    while name := word():
        word()
        size = struct.unpack_from("<I", data, at)[0]
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at


def channels_of(attribute):
    """(name, type) in the file's order."""
    at, channels = 0, []
    while attribute[at]:
        end = attribute.index(b"\0", at)
        kind = struct.unpack_from("<I", attribute, end + 1)[0]
        channels.append((attribute[at:end].decode(), ["uint", "half", "float"][kind]))
        at = end + 17
    return channels


def unzipped(block, size):
    """OpenEXR's ZIP: deflate of differences of bytes, odd ones behind even ones."""
    if len(block) == size:
        return block
    data = bytearray(zlib.decompress(block))
    for i in range(1, size):
        data[i] = (data[i] + data[i - 1] - 128) & 255
    half = (size + 1) // 2
    out = bytearray(size)
    out[0::2], out[1::2] = data[:half], data[half:]
    return bytes(out)


def read_exr(path):
    """Header, and values by channel, rows one after another; ZIP in rows alone."""
    data = Path(path).read_bytes()
    attributes, at = header_of(data)
    assert attributes["compression"] == b"\3" and attributes["lineOrder"] == b"\0"
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    channels = channels_of(attributes["channels"])
    values = {name: [] for name, _ in channels}
    for k in range((height + 15) // 16):
        place = struct.unpack_from("<Q", data, at + 8 * k)[0]
        first, size = struct.unpack_from("<iI", data, place)
        rows = min(16, bottom + 1 - first)
        row_bytes = sum(SIZE[kind][0] for _, kind in channels) * width
        block, i = unzipped(data[place + 8:place + 8 + size], rows * row_bytes), 0
        for _ in range(rows):
            for name, kind in channels:
                size, code = SIZE[kind]
                values[name] += struct.unpack_from(f"<{width}{code}", block, i)
                i += size * width
    return attributes, dict(channels), values


def read_png(data):
    """Width, and the values of an 8-bit PNG as the program writes it, with what stands behind it."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while True:
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        at += 12 + size
        if kind == b"IHDR":
            width, height, _, colour = struct.unpack_from(">IIBB", body)
        elif kind == b"IDAT":
            packed += body
        elif kind == b"IEND":
            break
    step = {0: 1, 2: 3, 6: 4}[colour]
    rows, length, above, out = zlib.decompress(packed), width * step, bytes(width * step), []
    for y in range(height):
        kind, row = rows[y * (length + 1)], bytearray(rows[y * (length + 1) + 1:(y + 1) * (length + 1)])
        for i in range(length):
            row[i] = (row[i] + (above[i] if kind == 2 else row[i - step] if i >= step else 0)) & 255
        out += row
        above = row
    return width, out, data[at:]


def write_pfm(path, pixels, width, height):
    rows = [pixels[y * width:(y + 1) * width] for y in reversed(range(height))]
    Path(path).write_bytes(f"PF\n{width} {height}\n-1\n".encode() +
                           b"".join(struct.pack("<3f", *p) for row in rows for p in row))

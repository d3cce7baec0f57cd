"""A decoder of one Zstandard frame after RFC 8878 that uses nothing of our code and no libzstd, so that both are tried.

It is as slow as it is plain. The names are those of the RFC.
"""

LIMIT = 16 << 20  # bytes of content: no section has more (format/SPEC.md, section 4.3)

NUMBER_OF_BITS = {  # of each code
    "literals length": [0] * 16 + [1, 1, 1, 1, 2, 2, 3, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16],
    "match length": [0] * 32 + [1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16],
    "offset": list(range(32)),
}
BASELINE = {  # of each code: where the values of the code before it end
    kind: [
        first + sum(1 << bits for bits in NUMBER_OF_BITS[kind][:code])
        for code in range(len(NUMBER_OF_BITS[kind]))
    ]
    for kind, first in (("literals length", 0), ("match length", 3), ("offset", 1))
}
DEFAULT_DISTRIBUTION = {
    "literals length": [4, 3] + [2] * 11 + [1] * 3 + [2] * 9 + [3, 2] + [1] * 5 + [-1] * 4,
    "match length": [1, 4, 3] + [2] * 6 + [1] * 37 + [-1] * 7,
    "offset": [1] * 6 + [2] * 3 + [1] * 15 + [-1] * 5,
}
MAX_ACCURACY_LOG = {"literals length": 9, "match length": 9, "offset": 8}


def check(rule, fault):
    if not rule:
        raise ValueError(f"not one Zstandard frame: {fault}")


class Fields:
    """Whole bytes, read from the front."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def left(self):
        return len(self.data) - self.at

    def take(self, count, what):
        check(count <= self.left(), f"{what} is cut off")
        self.at += count
        return self.data[self.at - count : self.at]

    def number(self, size, what):
        return int.from_bytes(self.take(size, what), "little")


class Bitstream:
    """Bits, read from the end of the data to its beginning."""

    def __init__(self, data):
        check(data and data[-1], "a bitstream has no final bit")
        self.data = bytes(4) + data  # what is peeked at below the beginning is 0
        self.left = 8 * len(data) - 9 + data[-1].bit_length()

    def peek(self, count):
        end = self.left + 32
        start = end - count
        return int.from_bytes(self.data[start >> 3 : (end + 7) >> 3], "little") >> (start & 7) & (
            (1 << count) - 1
        )

    def skip(self, count):
        check(count <= self.left, "a bitstream is cut off")
        self.left -= count

    def read(self, count):
        bits = self.peek(count)
        self.skip(count)
        return bits


def log2(table):
    """Of a table's length, a power of two: its Accuracy_Log or its Max_Number_of_Bits."""
    return len(table).bit_length() - 1


def fse_table(probabilities):
    """For each state its symbol, Num_Bits and Baseline (RFC 8878, section 4.1.1)."""
    size = sum(abs(probability) for probability in probabilities)
    symbols = [None] * size
    end, position = size, 0
    for symbol, probability in enumerate(probabilities):
        if probability == -1:
            end -= 1
            symbols[end] = symbol
    for symbol, probability in enumerate(probabilities):
        for _ in range(probability):
            symbols[position] = symbol
            position = (position + (size >> 1) + (size >> 3) + 3) % size
            while position >= end:
                position = (position + (size >> 1) + (size >> 3) + 3) % size
    shares = [abs(probability) for probability in probabilities]
    table = []
    for symbol in symbols:
        bits = log2(symbols) + 1 - shares[symbol].bit_length()
        table.append((symbol, bits, (shares[symbol] << bits) - size))
        shares[symbol] += 1
    return table


def read_fse_table(fields, max_accuracy_log, symbol_count):
    bits, at = int.from_bytes(fields.data[fields.at :], "little"), 4
    accuracy_log = (bits & 15) + 5
    check(accuracy_log <= max_accuracy_log, f"an FSE table has the Accuracy_Log {accuracy_log}")
    remaining, probabilities = 1 << accuracy_log, []
    while remaining:
        check(len(probabilities) < symbol_count, "an FSE table has too many symbols")
        width = (remaining + 1).bit_length()
        spare = (1 << width) - 2 - remaining  # so many values take one bit less
        half = 1 << (width - 1)
        value = bits >> at & (2 * half - 1)
        at += width
        if value & (half - 1) < spare:
            value &= half - 1
            at -= 1
        elif value >= half:
            value -= spare
        probabilities.append(value - 1)
        remaining -= abs(value - 1)
        repeat = 3 if value == 1 else 0
        while repeat == 3 and len(probabilities) < symbol_count:
            repeat = bits >> at & 3
            at += 2
            probabilities += [0] * repeat
    fields.take((at + 7) // 8, "an FSE table")
    check(len(probabilities) - probabilities.count(0) >= 2, "an FSE table has one symbol only")
    return fse_table(probabilities)


def read_fse_weights(data):
    """Two states take turns until one of them would need more bits than there are."""
    fields = Fields(data)
    table = read_fse_table(fields, 6, 256)
    bits = Bitstream(fields.take(fields.left(), "a weight bitstream"))
    state = bits.read(log2(table))
    other = bits.read(log2(table))
    weights = []
    while True:
        check(len(weights) <= 253, "more than 255 Huffman weights")
        weight, count, baseline = table[state]
        weights.append(weight)
        if count > bits.left:
            return weights + [table[other][0]]
        state, other = other, baseline + bits.read(count)


def read_huffman_table(fields):
    """For each Max_Number_of_Bits bits, the symbol that they begin with and its Number_of_Bits (RFC 8878, section 4.2.1)."""
    header = fields.number(1, "the Huffman tree header")
    if header < 128:
        weights = read_fse_weights(fields.take(header, "the Huffman tree description"))
    else:
        packed = fields.take((header - 126) // 2, "the Huffman tree description")
        weights = [weight for byte in packed for weight in (byte >> 4, byte & 15)][: header - 127]
    total = sum(1 << weight >> 1 for weight in weights)
    max_bits = total.bit_length()
    check(1 <= max_bits <= 11, "Huffman codes with no bits or more than 11")
    last = (1 << max_bits) - total
    check(last & (last - 1) == 0, "the last Huffman weight does not complete a power of two")
    weights.append(last.bit_length())
    check(1 in weights, "no Huffman code has the greatest length")
    return [
        (symbol, max_bits + 1 - weight)
        for weight in range(1, max_bits + 1)
        for symbol, its_weight in enumerate(weights)
        if its_weight == weight
        for _ in range(1 << (weight - 1))
    ]


def decode_huffman_stream(data, table, size):
    bits, max_bits, symbols = Bitstream(data), log2(table), bytearray()
    for _ in range(size):
        symbol, count = table[bits.peek(max_bits)]
        bits.skip(count)
        symbols.append(symbol)
    check(bits.left == 0, "a Huffman-coded stream is not used up")
    return symbols


class Frame:
    """What a block finds of the blocks before it."""

    def __init__(self, window_size):
        self.window_size = window_size
        self.block_maximum_size = min(window_size, 128 << 10)
        self.content = bytearray()
        self.huffman_table = None
        self.fse_tables = {}
        self.repeated_offsets = [1, 4, 8]

    def read_literals(self, fields):
        what = "the Literals_Section_Header"
        header = fields.number(1, what)
        block_type, size_format = header & 3, header >> 2 & 3
        if block_type <= 1:  # Raw_Literals_Block, RLE_Literals_Block
            header |= fields.number((0, 1, 0, 2)[size_format], what) << 8
            regenerated_size = header >> (4 if size_format & 1 else 3)
        else:
            width = (10, 10, 14, 18)[size_format]
            header |= fields.number((2, 2, 3, 4)[size_format], what) << 8
            regenerated_size, compressed_size = header >> 4 & ((1 << width) - 1), header >> (4 + width)
        check(regenerated_size <= self.block_maximum_size, "more literals than Block_Maximum_Size")
        if block_type == 0:
            return fields.take(regenerated_size, "a Raw_Literals_Block")
        if block_type == 1:
            return fields.take(1, "an RLE_Literals_Block") * regenerated_size
        streams = Fields(fields.take(compressed_size, "a block of compressed literals"))
        if block_type == 2:
            self.huffman_table = read_huffman_table(streams)
        check(self.huffman_table, "a Treeless_Literals_Block without a Huffman tree before it")
        if size_format == 0:
            return decode_huffman_stream(
                streams.take(streams.left(), "Stream1"), self.huffman_table, regenerated_size
            )
        check(regenerated_size >= 6, "four Huffman-coded streams for fewer than 6 literals")
        stream_sizes = [streams.number(2, "the jump table") for _ in range(3)]
        size, literals = (regenerated_size + 3) // 4, bytearray()
        for stream_size in stream_sizes:
            literals += decode_huffman_stream(
                streams.take(stream_size, "a Huffman-coded stream"), self.huffman_table, size
            )
        stream = streams.take(streams.left(), "Stream4")
        return literals + decode_huffman_stream(stream, self.huffman_table, regenerated_size - 3 * size)

    def read_sequence_table(self, fields, kind, mode):
        if mode == 0:  # Predefined_Mode
            self.fse_tables[kind] = fse_table(DEFAULT_DISTRIBUTION[kind])
        elif mode == 1:  # RLE_Mode
            symbol = fields.number(1, f"the {kind} code")
            check(symbol < len(NUMBER_OF_BITS[kind]), f"the {kind} code {symbol}")
            self.fse_tables[kind] = [(symbol, 0, 0)]
        elif mode == 2:  # FSE_Compressed_Mode
            self.fse_tables[kind] = read_fse_table(fields, MAX_ACCURACY_LOG[kind], len(NUMBER_OF_BITS[kind]))
        check(kind in self.fse_tables, f"Repeat_Mode without a {kind} table before it")

    def read_sequences(self, fields):
        """For each sequence its offset_value, match_length and literals_length."""
        count = fields.number(1, "Number_of_Sequences")
        if count == 255:
            count = fields.number(2, "Number_of_Sequences") + 0x7F00
        elif count >= 128:
            count = ((count - 128) << 8) + fields.number(1, "Number_of_Sequences")
        if count == 0:
            check(fields.left() == 0, "bytes behind a block without sequences")
            return
        modes = fields.number(1, "the compression modes of the sequences")
        check(modes & 3 == 0, "reserved bits of the compression modes are set")
        for kind, shift in (("literals length", 6), ("offset", 4), ("match length", 2)):
            self.read_sequence_table(fields, kind, modes >> shift & 3)
        bits = Bitstream(fields.take(fields.left(), "the sequences"))
        states = {
            kind: bits.read(log2(self.fse_tables[kind]))
            for kind in ("literals length", "offset", "match length")
        }
        for left in reversed(range(count)):
            codes = {kind: self.fse_tables[kind][state][0] for kind, state in states.items()}
            yield [
                BASELINE[kind][codes[kind]] + bits.read(NUMBER_OF_BITS[kind][codes[kind]])
                for kind in ("offset", "match length", "literals length")
            ]
            for kind in ("literals length", "match length", "offset") if left else ():
                _, num_bits, baseline = self.fse_tables[kind][states[kind]]
                states[kind] = baseline + bits.read(num_bits)
        check(bits.left == 0, "the bitstream of the sequences is not used up")

    def use_offset(self, offset_value, literals_length):
        offsets = self.repeated_offsets
        if offset_value > 3:
            offsets[:] = [offset_value - 3] + offsets[:2]
        else:
            index = offset_value - (1 if literals_length else 0)
            offset = offsets[index] if index < 3 else offsets[0] - 1
            del offsets[min(index, 2)]
            offsets.insert(0, offset)
        return offsets[0]

    def decode_compressed_block(self, data):
        fields, content, used = Fields(data), self.content, 0
        literals = self.read_literals(fields)
        end = len(content) + self.block_maximum_size
        for offset_value, match_length, literals_length in self.read_sequences(fields):
            check(literals_length <= len(literals) - used, "sequences with more literals than there are")
            check(
                len(content) + literals_length + match_length <= end,
                "a block is larger than Block_Maximum_Size",
            )
            content += literals[used : used + literals_length]
            used += literals_length
            offset = self.use_offset(offset_value, literals_length)
            # The RFC has offsets smaller than Window_Size; libzstd writes that one too, and a window holds it.
            check(
                1 <= offset <= min(len(content), self.window_size),
                "an offset is 0 or beyond the content or Window_Size",
            )
            start = len(content) - offset
            match = content[start : start + match_length]
            content += (match * (match_length // len(match) + 1))[
                :match_length
            ]  # where it overlaps itself, it repeats
        content += literals[used:]
        check(len(content) <= end, "a block is larger than Block_Maximum_Size")

    def decode_block(self, fields):
        """Whether it was the Last_Block."""
        header = fields.number(3, "a Block_Header")
        block_type, block_size = header >> 1 & 3, header >> 3
        check(block_type != 3, "a block has the reserved type")
        check(block_size <= self.block_maximum_size, "a block is larger than Block_Maximum_Size")
        if block_type == 0:
            self.content += fields.take(block_size, "a Raw_Block")
        elif block_type == 1:
            self.content += fields.take(1, "an RLE_Block") * block_size
        else:
            self.decode_compressed_block(fields.take(block_size, "a Compressed_Block"))
        check(len(self.content) <= LIMIT, f"the content has more than {LIMIT} bytes")
        return header & 1


def decode(data):
    """The content of exactly one frame without a dictionary; ValueError where the bytes are anything else."""
    fields = Fields(data)
    check(fields.number(4, "the Magic_Number") == 0xFD2FB528, "another Magic_Number")
    descriptor = fields.number(1, "the Frame_Header_Descriptor")
    check(not descriptor & 8, "the Reserved_bit is set")
    single_segment = descriptor >> 5 & 1
    if not single_segment:
        window = fields.number(1, "the Window_Descriptor")
        window_size = (8 + (window & 7)) << (7 + (window >> 3))
    check(fields.number((0, 1, 2, 4)[descriptor & 3], "the Dictionary_ID") == 0, "it needs a dictionary")
    size_bytes = (single_segment, 2, 4, 8)[descriptor >> 6]
    content_size = fields.number(size_bytes, "the Frame_Content_Size") + (256 if size_bytes == 2 else 0)
    frame = Frame(content_size if single_segment else window_size)
    while not frame.decode_block(fields):
        pass
    if size_bytes:
        check(
            len(frame.content) == content_size,
            f"{len(frame.content)} bytes of content where {content_size} were announced",
        )
    if descriptor & 4:
        from sector_file import xxh64  # here, since sector_file imports this module

        checksum = fields.number(4, "the Content_Checksum")
        check(checksum == xxh64(frame.content) & 0xFFFFFFFF, "the Content_Checksum is wrong")
    check(fields.left() == 0, "bytes behind the frame")
    return bytes(frame.content)

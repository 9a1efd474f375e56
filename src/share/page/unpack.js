// From the text in the page to voxels: digits of base 91, then deflate (RFC 1950, 1951).

// Pairs of digits hold 13 bits each, high bits first. Digits are the printable characters from ! on without & < \.
function bytesOfText(text, count) {
    const digit = new Uint8Array(128);
    let value = 0;
    for (let code = 33; code < 127; ++code)
        if (!"&<\\".includes(String.fromCharCode(code))) digit[code] = value++;
    const bytes = new Uint8Array(count);
    let held = 0, bits = 0, at = 0;
    for (let i = 0; i + 1 < text.length; i += 2) {
        held = (held << 13) | (digit[text.charCodeAt(i)] * 91 + digit[text.charCodeAt(i + 1)]);
        for (bits += 13; bits >= 8 && at < count;) {
            bits -= 8;
            bytes[at++] = held >> bits;
        }
        held &= (1 << bits) - 1;
    }
    return bytes;
}

// What browsers without DecompressionStream get.
function inflated(packed, count) {
    const out = new Uint8Array(count);
    let from = 2, at = 0, held = 0, bits = 0; // 2: behind the header of RFC 1950

    function take(n) {
        while (bits < n) {
            held |= packed[from++] << bits;
            bits += 8;
        }
        const value = held & ((1 << n) - 1);
        held >>>= n;
        bits -= n;
        return value;
    }
    // A table over the next `longest` bits: 16 * symbol + length of its code.
    function tableOf(lengths) {
        const counts = new Array(16).fill(0);
        for (const length of lengths) if (length > 0) ++counts[length];
        let longest = 15;
        while (longest > 1 && counts[longest] === 0) --longest;
        const next = [0, 0];
        for (let length = 1; length < 15; ++length) next[length + 1] = (next[length] + counts[length]) << 1;
        const entries = new Int32Array(1 << longest);
        lengths.forEach((length, symbol) => {
            if (length === 0) return;
            let code = next[length]++, turned = 0;
            for (let b = 0; b < length; ++b, code >>= 1) turned = (turned << 1) | (code & 1);
            for (let e = turned; e < entries.length; e += 1 << length) entries[e] = 16 * symbol + length;
        });
        return { entries, longest };
    }
    function symbolBy(table) {
        while (bits < table.longest && from < packed.length + 2) {
            held |= (packed[from++] | 0) << bits;
            bits += 8;
        }
        const entry = table.entries[held & ((1 << table.longest) - 1)];
        held >>>= entry & 15;
        bits -= entry & 15;
        return entry >> 4;
    }
    // Base and extra bits of lengths and distances.
    function steps(first, group, count) {
        const base = [], extra = [];
        for (let i = 0, value = first; i < count; ++i) {
            extra.push(Math.max(0, Math.floor(i / group) - 1));
            base.push(value);
            value += 1 << extra[i];
        }
        return { base, extra };
    }
    const lengths = steps(3, 4, 28), distances = steps(1, 2, 30);
    lengths.base.push(258);
    lengths.extra.push(0);

    function plainTables() {
        const of = (n, length) => new Array(n).fill(length);
        return [tableOf([...of(144, 8), ...of(112, 9), ...of(24, 7), ...of(8, 8)]), tableOf(of(30, 5))];
    }
    function ownTables() {
        const literals = take(5) + 257, ways = take(5) + 1, codes = take(4) + 4;
        const own = new Array(19).fill(0);
        const order = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];
        for (let i = 0; i < codes; ++i) own[order[i]] = take(3);
        const table = tableOf(own), all = [];
        while (all.length < literals + ways) {
            const symbol = symbolBy(table);
            if (symbol < 16) all.push(symbol);
            else {
                const value = symbol === 16 ? all[all.length - 1] : 0;
                const times = symbol === 16 ? 3 + take(2) : symbol === 17 ? 3 + take(3) : 11 + take(7);
                for (let i = 0; i < times; ++i) all.push(value);
            }
        }
        return [tableOf(all.slice(0, literals)), tableOf(all.slice(literals))];
    }

    for (let last = 0; !last;) {
        last = take(1);
        const kind = take(2);
        if (kind === 0) {
            take(bits & 7);
            const size = take(8) | (take(8) << 8);
            take(16);
            from -= bits >> 3;
            held = bits = 0;
            out.set(packed.subarray(from, from + size), at);
            from += size;
            at += size;
            continue;
        }
        const [literals, ways] = kind === 1 ? plainTables() : ownTables();
        for (let symbol = symbolBy(literals); symbol !== 256; symbol = symbolBy(literals)) {
            if (at >= count || from > packed.length + 4) throw new Error("the voxels in this file are damaged");
            if (symbol < 256) {
                out[at++] = symbol;
                continue;
            }
            const length = lengths.base[symbol - 257] + take(lengths.extra[symbol - 257]);
            const way = symbolBy(ways), back = distances.base[way] + take(distances.extra[way]);
            for (let i = 0; i < length; ++i, ++at) out[at] = out[at - back];
        }
    }
    return out;
}

async function unpacked(packed, count) {
    if (typeof DecompressionStream === "undefined") return inflated(packed, count);
    const out = new Uint8Array(count);
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const reader = stream.getReader();
    let at = 0;
    for (;;) {
        const { done, value } = await reader.read();
        if (done) break;
        out.set(value, at);
        at += value.length;
    }
    if (at !== count) throw new Error("the voxels in this file are damaged");
    return out;
}

// What rays leap over: blocks in which nothing is opaque (src/render/ray_blocks.h).

const kBlockShift = 2, kMostDistance = 15;

// codes: those of all voxels; valid: 1 where they are, or null. Lowest and highest code per block.
function rangesOf(codes, valid, dims) {
    const [nx, ny, nz] = dims, size = 1 << kBlockShift;
    const blocks = dims.map(n => Math.max(1, (n - 2 + size) >> kBlockShift));
    const low = new Uint16Array(blocks[0] * blocks[1] * blocks[2]).fill(65535), high = new Uint16Array(low.length);
    for (let bz = 0, b = 0; bz < blocks[2]; ++bz)
        for (let by = 0; by < blocks[1]; ++by)
            for (let bx = 0; bx < blocks[0]; ++bx, ++b) {
                const x1 = Math.min(nx - 1, (bx + 1) * size), y1 = Math.min(ny - 1, (by + 1) * size), z1 = Math.min(nz - 1, (bz + 1) * size);
                let least = 65535, most = 0;
                for (let z = bz * size; z <= z1; ++z)
                    for (let y = by * size; y <= y1; ++y)
                        for (let i = (z * ny + y) * nx + bx * size, end = (z * ny + y) * nx + x1; i <= end; ++i) {
                            if (valid && !valid[i]) continue;
                            const code = codes[i];
                            if (code < least) least = code;
                            if (code > most) most = code;
                        }
                low[b] = least;
                high[b] = most;
            }
    return valid ? joined({ low, high, blocks }) : { low, high, blocks };
}

// Across invalid voxels intensities go from one block to the next: each takes in those of its neighbours.
function joined({ low, high, blocks }) {
    const lows = low.slice(), highs = high.slice();
    forNeighbours(blocks, 1, 26, (b, n) => {
        lows[b] = Math.min(lows[b], low[n]);
        highs[b] = Math.max(highs[b], high[n]);
    });
    return { low: lows, high: highs, blocks };
}

// Calls use(block, neighbour) in the order of blocks, or backward, for neighbours over faces, edges and corners: the 13
// that come before in that order, or all 26.
function forNeighbours([nx, ny, nz], way, count, use) {
    const ways = [];
    for (let z = -1; z <= 1; ++z)
        for (let y = -1; y <= 1; ++y)
            for (let x = -1; x <= 1; ++x)
                if ((x || y || z) && (count === 26 || (z * 3 + y) * 3 + x < 0)) ways.push([x * way, y * way, z * way]);
    const total = nx * ny * nz;
    for (let n = 0; n < total; ++n) {
        const b = way > 0 ? n : total - 1 - n, x = b % nx, y = Math.floor(b / nx) % ny, z = Math.floor(b / (nx * ny));
        for (const [dx, dy, dz] of ways) {
            const u = x + dx, v = y + dy, w = z + dz;
            if (u >= 0 && v >= 0 && w >= 0 && u < nx && v < ny && w < nz) use(b, (w * ny + v) * nx + u);
        }
    }
}

// How many blocks off the next one is in which anything is opaque; 0 where it is itself.
function distancesOf({ low, high, blocks }, opaqueBefore, maxCode) {
    const distance = new Uint8Array(low.length), perCode = (kTableSize - 1) / maxCode;
    for (let b = 0; b < low.length; ++b) {
        // An entry more on both sides: devices round in their own ways.
        const first = Math.max(0, Math.floor(low[b] * perCode) - 1), end = Math.min(kTableSize, Math.floor(high[b] * perCode) + 3);
        distance[b] = low[b] <= high[b] && opaqueBefore[end] !== opaqueBefore[first] ? 0 : kMostDistance;
    }
    const hear = (b, n) => {
        if (distance[n] + 1 < distance[b]) distance[b] = distance[n] + 1;
    };
    forNeighbours(blocks, 1, 13, hear);
    forNeighbours(blocks, -1, 13, hear);
    return distance;
}

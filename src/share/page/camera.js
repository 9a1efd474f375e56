// Vectors, and where the volume is looked at from (src/render/camera.h).

const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = a => Math.sqrt(dot(a, a));
const unit = a => scaled(a, 1 / length(a));
// Matrices are three columns.
const times = (m, v) => add(add(scaled(m[0], v[0]), m[1], v[1]), m[2], v[2]);
const transposed = m => [0, 1, 2].map(r => [m[0][r], m[1][r], m[2][r]]);
function inverse(m) {
    const det = dot(m[0], cross(m[1], m[2]));
    return transposed([scaled(cross(m[1], m[2]), 1 / det), scaled(cross(m[2], m[0]), 1 / det), scaled(cross(m[0], m[1]), 1 / det)]);
}
// v turned about the unit vector axis, in radians (Rodrigues).
const turned = (v, axis, angle) => add(add(scaled(v, Math.cos(angle)), cross(axis, v), Math.sin(angle)), axis, dot(axis, v) * (1 - Math.cos(angle)));

class Camera {
    constructor(json) {
        Object.assign(this, JSON.parse(JSON.stringify(json)));
    }
    forward() { return unit(add(this.center, this.eye, -1)); }
    right() { return unit(cross(this.forward(), this.up)); }
    trueUp() { return cross(this.right(), this.forward()); }
    isPerspective() { return this.projection === "perspective"; }
    // Of the picture's height, world units; perspective: at depth 1.
    halfHeight() { return this.isPerspective() ? Math.tan(this.fov_y * Math.PI / 360) : this.height / 2; }
    distance() { return length(add(this.eye, this.center, -1)); }

    // Radians; the upright axis stays upright.
    turn(sideways, upward) {
        let off = turned(add(this.eye, this.center, -1), unit(this.up), -sideways);
        const right = turned(this.right(), unit(this.up), -sideways);
        const steep = Math.acos(Math.max(-1, Math.min(1, dot(unit(off), unit(this.up)))));
        const least = 0.02;
        off = turned(off, right, -Math.max(least - (Math.PI - steep), Math.min(steep - least, upward)));
        this.eye = add(this.center, off);
    }
    // In halves of the picture's height.
    move(x, y) {
        const scale = this.halfHeight() * (this.isPerspective() ? this.distance() : 1);
        const way = add(scaled(this.right(), -x * scale), this.trueUp(), -y * scale);
        this.eye = add(this.eye, way);
        this.center = add(this.center, way);
    }
    zoom(factor, radius) {
        if (!this.isPerspective()) {
            this.height = Math.max(radius / 50, Math.min(radius * 20, this.height / factor));
            return;
        }
        const far = Math.max(radius / 50, Math.min(radius * 40, this.distance() / factor));
        this.eye = add(this.center, unit(add(this.eye, this.center, -1)), far);
    }
    // Degrees, as --view of the command line takes them.
    angles() {
        const d = unit(add(this.eye, this.center, -1));
        return { azimuth: Math.atan2(d[0], -d[1]) * 180 / Math.PI, elevation: Math.asin(Math.max(-1, Math.min(1, d[2]))) * 180 / Math.PI };
    }
}

// The rays of a picture, in voxels (src/render/gl/picture_rays.h).
function raysOf(camera, volume, aspect, halfHeight) {
    const toIndex = inverse(volume.axes), extent = [halfHeight * aspect, halfHeight];
    const forward = camera.forward(), ahead = dot(add(volume.center, camera.eye, -1), forward);
    const right = scaled(times(toIndex, camera.right()), extent[0]), up = scaled(times(toIndex, camera.trueUp()), extent[1]);
    const axis = times(toIndex, add(add(camera.eye, forward, ahead), volume.origin, -1)), along = times(toIndex, forward);
    return camera.isPerspective()
        ? { origin: [scaled(right, ahead), scaled(up, ahead), axis], direction: [right, up, along], tangents: extent, nearest: -ahead }
        : { origin: [right, up, axis], direction: [[0, 0, 0], [0, 0, 0], along], tangents: [0, 0], nearest: -1e30 };
}

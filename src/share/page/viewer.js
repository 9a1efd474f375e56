// What is shown, and the picture of it: quick while it changes, fine when it rests.

class Viewer {
    constructor(canvas, scene, raycaster) {
        Object.assign(this, { canvas, scene, raycaster });
        this.scale = 0.5;     // rays per pixel of quick pictures
        this.changed = false; // since the latest quick picture
        this.settled = null;  // resolved when the picture rests
        this.reset();
        new ResizeObserver(() => this.change()).observe(canvas);
        canvas.addEventListener("webglcontextlost", event => event.preventDefault());
        canvas.addEventListener("webglcontextrestored", () => {
            raycaster.restore();
            this.change();
        });
    }
    // The saved view.
    reset() {
        const { scene } = this;
        this.camera = new Camera(scene.camera);
        this.shown = scene.tf.features.map(f => !f.hidden);
        this.opacities = scene.tf.features.map(f => f.opacity);
        this.coverage = scene.density ? scene.density.at : null;
        this.clip = { lo: scene.view.clip.lo.slice(), hi: scene.view.clip.hi.slice(), front: 0, frontPlane: null };
        this.light = scene.view.light.on;
        this.changeTf();
    }
    changeTf() {
        this.raycaster.setTables(tablesOf(this.scene, this.opacities, this.shown));
        this.change();
    }
    setCoverage(coverage) {
        this.coverage = coverage;
        // The curve has no opacity for what was hidden when it was followed: that keeps its own.
        const own = this.scene.tf.features.map(f => f.opacity);
        this.opacities = opacitiesAt(this.scene.density, coverage).map((x, f) => x > 0 ? x : own[f]);
        this.changeTf();
    }
    // Cuts away what lies nearer than a part of the way through the sphere around the volume, 0 to 1, seen from here.
    cutFront(part) {
        const { volume } = this.scene, toEye = scaled(this.camera.forward(), -1);
        this.clip.front = part;
        const offset = dot(toEye, volume.center) + volume.radius * (1 - 2 * part);
        this.clip.frontPlane = part > 0 ? planeInVoxels(volume, toEye, offset) : null;
        this.change();
    }
    look(aspect) {
        const { camera, clip, scene } = this, planes = scene.view.clip.planes.slice();
        if (clip.frontPlane) planes.push(clip.frontPlane);
        // A picture that is taller than wide has the width that a square one would have.
        const halfHeight = camera.halfHeight() / Math.min(1, aspect);
        return { camera, halfHeight, light: this.light, clip: { lo: clip.lo, hi: clip.hi, planes } };
    }
    change() {
        this.changed = true;
        if (!this.settled) {
            this.settled = this.settle().catch(error => this.failed && this.failed(error)).finally(() => { this.settled = null; });
        }
    }
    async settle() {
        const frame = () => new Promise(done => requestAnimationFrame(done));
        do {
            await frame();
            this.changed = false;
            this.resize();
            const { width, height } = this.canvas, start = performance.now();
            this.raycaster.drawQuick(this.look(width / height), width, height, this.scale);
            await this.raycaster.finished();
            this.canvas.classList.remove("waiting");
            this.adapt(performance.now() - start);
            for (let waited = performance.now(); !this.changed && performance.now() - waited < 120;) await frame();
            if (!this.changed) await this.refine(width, height, frame);
        } while (this.changed);
    }
    // The fine picture from above, in strips that take little time each; stops where something changes.
    async refine(width, height, frame) {
        let top = height, rows = 16;
        while (top > 0 && !this.changed) {
            const from = Math.max(0, top - rows), start = performance.now();
            this.raycaster.draw(this.look(width / height), true, width, height, from, top);
            await this.raycaster.finished();
            const spent = performance.now() - start;
            top = from;
            if (spent < 12) rows = Math.min(height, rows * 2);
            if (spent > 40) rows = Math.max(4, rows >> 1);
            if (spent > 12) await frame();
        }
        this.isFine = top <= 0;
    }
    adapt(milliseconds) {
        const wanted = this.scale * Math.sqrt(30 / Math.max(1, milliseconds));
        this.scale = Math.max(0.2, Math.min(1, 0.5 * (this.scale + wanted)));
    }
    resize() {
        const { canvas } = this, kMostPixels = 6e6;
        let dense = window.devicePixelRatio || 1;
        const w = canvas.clientWidth, h = canvas.clientHeight;
        dense *= Math.min(1, Math.sqrt(kMostPixels / Math.max(1, w * h * dense * dense)));
        const width = Math.max(1, Math.round(w * dense)), height = Math.max(1, Math.round(h * dense));
        if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    }
    // With the camera as it is, as pellucid-cli render draws it.
    picture(width, height) {
        return this.raycaster.picture(this.look(1), width, height);
    }
    // What the canvas shows.
    pictureAsSeen() {
        const { width, height } = this.canvas;
        return this.raycaster.picture(this.look(width / height), width, height);
    }
}

// dot(normal, p) <= offset, in the world, as (normal, offset) among voxels.
function planeInVoxels(volume, normal, offset) {
    const among = times(transposed(volume.axes), normal);
    return [...among, offset - dot(normal, volume.origin)];
}

// Draws the volume with WebGL 2, by the shaders of the gl renderer (src/render/gl/volume_raycaster.h).

const kVertexShader = `#version 300 es
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}`;
const kTurnOfLight = 0.4, kTolerance = 0.4 / 255; // kLightTurn and kHalvingTolerance of src/render/cpu/ray_packets.h

class Raycaster {
    // voxels: codes, what is valid (or null), openness (or null), as page.js unpacks them.
    constructor(canvas, scene, shader, voxels) {
        this.scene = scene;
        this.shader = shader;
        this.voxels = voxels;
        this.gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false, preserveDrawingBuffer: true });
        if (!this.gl) throw new Error("this browser has no WebGL 2");
        const most = this.gl.getParameter(this.gl.MAX_3D_TEXTURE_SIZE);
        if (Math.max(...scene.volume.dims) > most) throw new Error(`this device draws at most ${most} voxels along an axis`);
        this.ranges = rangesOf(voxels.codes, voxels.valid, scene.volume.dims);
        this.restore();
    }
    // Everything that lies in the context: also after it was lost.
    restore() {
        const { gl, scene } = this;
        this.programs = new Map();
        this.vertices = gl.createVertexArray();
        gl.bindVertexArray(this.vertices);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        gl.disable(gl.DITHER);
        this.volume = this.texture(gl.TEXTURE_3D, gl.LINEAR);
        this.uploadVolume();
        this.table = this.texture(gl.TEXTURE_2D, gl.NEAREST);
        this.distances = this.texture(gl.TEXTURE_3D, gl.NEAREST);
        this.openness = null;
        if (scene.openness) {
            this.openness = this.texture(gl.TEXTURE_3D, gl.LINEAR);
            gl.texImage3D(gl.TEXTURE_3D, 0, gl.R8, ...scene.openness.dims, 0, gl.RED, gl.UNSIGNED_BYTE, this.voxels.openness);
        }
        this.quick = { texture: null, framebuffer: null, width: 0, height: 0 };
        this.opaqueBefore = null;
        if (this.tables) this.setTables(this.tables);
    }
    texture(target, filter) {
        const { gl } = this, name = gl.createTexture();
        gl.bindTexture(target, name);
        for (const which of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(target, which, filter);
        for (const way of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) gl.texParameteri(target, way, gl.CLAMP_TO_EDGE);
        return name;
    }
    // Layer by layer, so that the channels of all voxels need not be in memory at once.
    uploadVolume() {
        const { gl } = this, [nx, ny, nz] = this.scene.volume.dims, { codes, valid } = this.voxels;
        const wide = this.scene.volume.bits === 16, channels = wide ? (valid ? 4 : 2) : valid ? 2 : 1;
        const internal = [0, gl.R8, gl.RG8, 0, gl.RGBA8][channels], format = [0, gl.RED, gl.RG, 0, gl.RGBA][channels];
        gl.texStorage3D(gl.TEXTURE_3D, 1, internal, nx, ny, nz);
        const layer = nx * ny, texels = new Uint8Array(layer * channels);
        for (let z = 0; z < nz; ++z) {
            for (let i = 0, v = z * layer; i < layer; ++i, ++v) {
                const at = i * channels;
                if (wide) texels[at] = codes[v] >> 8;
                texels[at + (wide ? 1 : 0)] = codes[v] & 255;
                if (valid) texels[at + (wide ? 2 : 1)] = valid[v] ? 255 : 0;
            }
            gl.texSubImage3D(gl.TEXTURE_3D, 0, 0, 0, z, nx, ny, 1, format, gl.UNSIGNED_BYTE, texels);
        }
    }
    setTables(tables) {
        const { gl, scene } = this;
        this.tables = tables;
        gl.activeTexture(gl.TEXTURE0);
        gl.bindTexture(gl.TEXTURE_2D, this.table);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, 256, 2 * kTableSize / 256, 0, gl.RGBA, gl.FLOAT, tables.values);
        const same = this.opaqueBefore && tables.opaqueBefore.every((n, i) => n === this.opaqueBefore[i]);
        if (same) return;
        this.opaqueBefore = tables.opaqueBefore;
        gl.bindTexture(gl.TEXTURE_3D, this.distances);
        gl.texImage3D(gl.TEXTURE_3D, 0, gl.R8UI, ...this.ranges.blocks, 0, gl.RED_INTEGER, gl.UNSIGNED_BYTE,
            distancesOf(this.ranges, tables.opaqueBefore, scene.volume.max_code));
    }
    program(defines) {
        const key = defines.join(" ");
        if (this.programs.has(key)) return this.programs.get(key);
        const { gl } = this;
        const head = "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n" +
            "precision highp sampler3D;\nprecision highp usampler3D;\n" + defines.map(d => `#define ${d}\n`).join("");
        const name = gl.createProgram();
        for (const [kind, text] of [[gl.VERTEX_SHADER, kVertexShader], [gl.FRAGMENT_SHADER, head + this.shader]]) {
            const shader = gl.createShader(kind);
            gl.shaderSource(shader, text);
            gl.compileShader(shader);
            gl.attachShader(name, shader);
            if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
                throw new Error("a shader does not compile: " + gl.getShaderInfoLog(shader));
        }
        gl.linkProgram(name);
        if (!gl.getProgramParameter(name, gl.LINK_STATUS) && !gl.isContextLost())
            throw new Error("the shaders do not link: " + gl.getProgramInfoLog(name));
        const at = new Map();
        const count = gl.getProgramParameter(name, gl.ACTIVE_UNIFORMS) || 0;
        for (let i = 0; i < count; ++i) {
            const uniform = gl.getActiveUniform(name, i).name;
            at.set(uniform.replace("[0]", ""), gl.getUniformLocation(name, uniform));
        }
        this.programs.set(key, { name, at });
        return this.programs.get(key);
    }

    // look: camera, clip {lo, hi, planes}, light (on or off), halfHeight. fine: the picture as it rests, else a quick
    // one. Draws the part of a width x height picture that lies in the rows [from, to), counted from below.
    draw(look, fine, width, height, from, to) {
        const { gl, scene } = this, { volume, view } = scene;
        const light = view.light, lit = look.light || light.gradient_opacity > 0 || light.depth_cue > 0 || light.silhouettes > 0 || light.occlusion > 0;
        const faint = view.faint !== undefined && view.faint.density > 0;
        const halvings = fine ? view.halvings : 0;
        const defines = [`BLOCK_SHIFT ${kBlockShift}`];
        if (volume.bits === 16) defines.push("WIDE");
        if (volume.has_invalid) defines.push("HAS_INVALID");
        if (halvings > 0) defines.push("HALVES");
        if (faint) defines.push("FAINT");
        if (lit) defines.push("LIGHT");
        if (lit && light.gradient_opacity > 0) defines.push("GRADIENT_OPACITY");
        if (lit && this.openness) defines.push("OCCLUSION");
        const { name, at } = this.program(defines);
        gl.useProgram(name);
        const set = (kind, uniform, ...value) => at.has(uniform) && gl["uniform" + kind](at.get(uniform), ...value);
        const setMatrix = (uniform, columns) => at.has(uniform) && gl.uniformMatrix3fv(at.get(uniform), false, columns.flat());
        const setPlanes = (count, uniform, planes) => {
            set("1i", count, planes.length);
            if (planes.length > 0) set("4fv", uniform, planes.flat());
        };
        const bind = (unit, target, texture, uniform) => {
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(target, texture);
            set("1i", uniform, unit);
        };
        bind(0, gl.TEXTURE_3D, this.volume, "u_volume");
        bind(1, gl.TEXTURE_2D, this.table, "u_tfTable");
        bind(2, gl.TEXTURE_3D, this.distances, "u_distances");
        if (this.openness) bind(3, gl.TEXTURE_3D, this.openness, "u_openness");

        const { camera } = look, { dims } = volume, d0 = volume.d0;
        const rays = raysOf(camera, volume, width / height, look.halfHeight);
        set("4f", "u_pictureFromFragment", 2 / width, 2 / height, -1, -1);
        setMatrix("u_rayOrigin", rays.origin);
        setMatrix("u_rayDirection", rays.direction);
        set("2f", "u_tangents", ...rays.tangents);
        set("1f", "u_nearest", rays.nearest);
        const step = fine ? view.step : Math.max(view.step, 1);
        set("2f", "u_step", step * d0, step);
        set("3f", "u_halves", Math.pow(2, 1 - halvings), kTolerance, kTurnOfLight);
        set("3f", "u_boxLo", ...dims.map((n, a) => look.clip.lo[a] * n - 0.5));
        set("3f", "u_boxHi", ...dims.map((n, a) => look.clip.hi[a] * n - 0.5));
        const rest = view.faint ? view.faint.planes : [];
        setPlanes("u_planeCount", "u_planes", faint ? look.clip.planes : [...look.clip.planes, ...rest]);
        setPlanes("u_faintCount", "u_faint", rest);
        set("1f", "u_faintDensity", view.faint ? view.faint.density : 0);
        set("2f", "u_jitter", 0, 0);
        set("3f", "u_lastVoxel", ...dims.map(n => n - 1));
        set("3i", "u_lastBlock", ...this.ranges.blocks.map(n => n - 1));
        set("3f", "u_textureFromVoxel", ...dims.map(n => 1 / n));
        set("3f", "u_textureOffset", ...dims.map(n => 0.5 / n));
        const codes = (volume.bits === 16 ? 65535 : 255) / volume.max_code;
        set("1f", "u_entriesPerCode", codes * (kTableSize - 1));
        set("1i", "u_integralStart", kTableSize);

        const toIndex = inverse(volume.axes);
        const fromWorld = transposed([camera.right(), camera.trueUp(), scaled(camera.forward(), -1)]);
        setMatrix("u_cameraFromGradient", transposed(toIndex).map(column => scaled(times(fromWorld, column), 0.5 * codes * d0)));
        set("4f", "u_parts", ...(look.light ? [light.ambient, light.diffuse, light.specular, light.shininess] : [1, 0, 0, 1]));
        set("3f", "u_toLight", ...unit(light.direction));
        set("4f", "u_strengths", light.gradient_opacity, light.silhouettes, light.occlusion, light.depth_cue);
        set("3f", "u_cueColor", ...view.background);
        set("2f", "u_cue", 0.5 / volume.radius, 0.5);
        if (this.openness) {
            const cells = scene.openness.dims, size = scene.openness.cell;
            set("3f", "u_opennessFromVoxel", ...cells.map(n => 1 / (size * n)));
            set("3f", "u_opennessOffset", ...cells.map(n => (0.5 - 0.5 * (size - 1) / size) / n));
        }
        set("3f", "u_bottom", ...view.background);
        set("3f", "u_top", ...view.background_top);

        gl.viewport(0, 0, width, height);
        gl.enable(gl.SCISSOR_TEST);
        gl.scissor(0, from, width, to - from);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        gl.disable(gl.SCISSOR_TEST);
    }

    target(old, width, height) {
        const { gl } = this;
        if (old.width === width && old.height === height) return old;
        if (old.texture) {
            gl.deleteTexture(old.texture);
            gl.deleteFramebuffer(old.framebuffer);
        }
        gl.activeTexture(gl.TEXTURE0);
        const texture = this.texture(gl.TEXTURE_2D, gl.LINEAR), framebuffer = gl.createFramebuffer();
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, width, height);
        gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
        return { texture, framebuffer, width, height };
    }
    // A quick picture on the canvas with `scale` rays per pixel along each axis.
    drawQuick(look, width, height, scale) {
        const { gl } = this, w = Math.max(1, Math.round(width * scale)), h = Math.max(1, Math.round(height * scale));
        this.quick = this.target(this.quick, w, h);
        gl.bindFramebuffer(gl.FRAMEBUFFER, this.quick.framebuffer);
        this.draw(look, false, w, h, 0, h);
        gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.quick.framebuffer);
        gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
        gl.blitFramebuffer(0, 0, w, h, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.LINEAR);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    }
    // The picture as it rests, in a canvas of its own; rows from above. Lets the page live meanwhile.
    async picture(look, width, height) {
        const { gl } = this, target = this.target({}, width, height), pixels = new Uint8ClampedArray(4 * width * height);
        for (let from = 0, rows = 32; from < height; from += rows) {
            gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
            this.draw(look, true, width, height, from, Math.min(height, from + rows));
            gl.bindFramebuffer(gl.FRAMEBUFFER, null);
            await this.finished();
        }
        gl.bindFramebuffer(gl.FRAMEBUFFER, target.framebuffer);
        const upward = new Uint8Array(4 * width * height);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, upward);
        gl.bindFramebuffer(gl.FRAMEBUFFER, null);
        gl.deleteTexture(target.texture);
        gl.deleteFramebuffer(target.framebuffer);
        for (let y = 0; y < height; ++y) pixels.set(upward.subarray(4 * width * y, 4 * width * (y + 1)), 4 * width * (height - 1 - y));
        const canvas = document.createElement("canvas");
        canvas.width = width;
        canvas.height = height;
        canvas.getContext("2d").putImageData(new ImageData(pixels, width, height), 0, 0);
        return canvas;
    }
    // When the device has done what it was told.
    async finished() {
        const { gl } = this, fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
        gl.flush();
        while (!gl.isContextLost() && gl.getSyncParameter(fence, gl.SYNC_STATUS) !== gl.SIGNALED) await new Promise(done => setTimeout(done, 2));
        gl.deleteSync(fence);
    }
}

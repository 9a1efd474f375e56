// From the file to the picture.

async function open() {
    const started = performance.now(), scene = JSON.parse(part("scene").textContent);
    showFigures(scene);
    part("message").textContent = "Unpacking\u2026";
    await new Promise(done => setTimeout(done, 30)); // the still picture comes first
    const canvas = part("picture");
    const voxels = await voxelsOf(scene);
    const raycaster = new Raycaster(canvas, scene, part("ray.frag").textContent, voxels);
    canvas.hidden = false;
    const viewer = new Viewer(canvas, scene, raycaster);
    viewer.failed = fail;
    const act = connectPanel(viewer);
    takeInHand(viewer, act);
    part("message").textContent = "";
    hintOnce(canvas);
    return { scene, viewer, act, milliseconds: performance.now() - started };
}

// Planes of bytes one after the other: high bytes of 16 bits, low bytes, what is valid, openness.
async function voxelsOf(scene) {
    const { dims, bits, has_invalid } = scene.volume, count = dims[0] * dims[1] * dims[2];
    const opennessBytes = scene.openness ? scene.openness.dims.reduce((a, b) => a * b) : 0;
    const packed = bytesOfText(part("voxels").textContent, scene.data.packed);
    part("voxels").remove();
    const bytes = await unpacked(packed, count * (bits / 8 + (has_invalid ? 1 : 0)) + opennessBytes);
    let codes = bytes.subarray(0, count), at = count;
    if (bits === 16) {
        codes = new Uint16Array(count);
        for (let i = 0; i < count; ++i) codes[i] = (bytes[i] << 8) | bytes[count + i];
        at = 2 * count;
    }
    const valid = has_invalid ? bytes.subarray(at, at + count) : null;
    const openness = scene.openness ? bytes.subarray(bytes.length - opennessBytes) : null;
    return { codes, valid, openness };
}

function fail(error) {
    part("picture").hidden = true;
    part("message").textContent = `The picture cannot be turned here: ${error.message}. It is shown as it was saved.`;
}

function hintOnce(canvas) {
    const hint = part("hint");
    hint.classList.add("shown");
    const hide = () => hint.classList.remove("shown");
    canvas.addEventListener("pointerdown", hide, { once: true });
    setTimeout(hide, 5000);
}

// For scripts and tests: what is shown, and pictures of it.
const opened = open();
window.pellucid = {
    ready: opened.then(({ milliseconds }) => ({ milliseconds })),
    async state() {
        const { viewer } = await opened;
        return { camera: viewer.camera, shown: viewer.shown, opacities: viewer.opacities, coverage: viewer.coverage, light: viewer.light, clip: viewer.clip };
    },
    async settled() {
        const { viewer } = await opened;
        await viewer.settled;
        return true;
    },
    // A PNG as data: URL, `width` x `height` pixels, with the camera as it is.
    async picture(width, height) {
        const { viewer } = await opened;
        return (await viewer.picture(width, height)).toDataURL("image/png");
    },
};
opened.catch(fail);

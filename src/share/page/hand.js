// Mouse, fingers and keys on the picture.

function takeInHand(viewer, act) {
    const { canvas } = viewer, kTurn = Math.PI / 36, pointers = new Map();
    const radius = viewer.scene.volume.radius;
    const onCanvas = (dx, dy) => [2 * dx / canvas.clientHeight, -2 * dy / canvas.clientHeight];

    canvas.addEventListener("pointerdown", event => {
        canvas.focus({ preventScroll: true });
        canvas.setPointerCapture(event.pointerId);
        pointers.set(event.pointerId, [event.clientX, event.clientY]);
        event.preventDefault();
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
        canvas.addEventListener(end, event => {
            if (pointers.delete(event.pointerId) && pointers.size === 0) act.turned();
        });
    canvas.addEventListener("contextmenu", event => event.preventDefault());
    canvas.addEventListener("pointermove", event => {
        const last = pointers.get(event.pointerId);
        if (!last) return;
        const now = [event.clientX, event.clientY], dx = now[0] - last[0], dy = now[1] - last[1];
        const other = [...pointers].find(([id]) => id !== event.pointerId);
        pointers.set(event.pointerId, now);
        if (other) {
            const apart = p => Math.hypot(p[0] - other[1][0], p[1] - other[1][1]);
            viewer.camera.zoom(apart(now) / Math.max(1, apart(last)), radius);
            viewer.camera.move(...onCanvas(dx / 2, dy / 2));
        } else if (event.shiftKey || event.buttons & 6) {
            viewer.camera.move(...onCanvas(dx, dy));
        } else {
            const perPixel = Math.PI / Math.max(200, canvas.clientHeight);
            viewer.camera.turn(dx * perPixel, dy * perPixel);
        }
        viewer.change();
    });
    canvas.addEventListener("wheel", event => {
        event.preventDefault();
        const lines = event.deltaMode === 1 ? 16 : 1;
        viewer.camera.zoom(Math.exp(-event.deltaY * lines * 0.0015), radius);
        viewer.change();
    }, { passive: false });

    const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    canvas.addEventListener("keydown", event => {
        if (event.ctrlKey || event.altKey || event.metaKey) return;
        const way = turns[event.key];
        if (way && event.shiftKey) viewer.camera.move(way[0] * 0.1, way[1] * -0.1);
        else if (way) viewer.camera.turn(way[0] * kTurn, way[1] * kTurn);
        else if (event.key === "+" || event.key === "=") viewer.camera.zoom(1.15, radius);
        else if (event.key === "-" || event.key === "_") viewer.camera.zoom(1 / 1.15, radius);
        else if (event.key === "Home" || event.key === "0") act.reset();
        else if (/^[1-9]$/.test(event.key)) act.toggle(Number(event.key) - 1);
        else if (event.key === "[" || event.key === "]") act.stepDensity(event.key === "]" ? 1 : -1);
        else if (event.key === "l" || event.key === "L") act.switchLight();
        else return;
        event.preventDefault();
        viewer.change();
        act.turned();
    });
}

// The controls beside the picture.

const part = id => document.getElementById(id);
const percent = share => `${Math.round(100 * share)} %`;
const hexOf = rgb => "#" + rgb.map(c => Math.round(255 * c).toString(16).padStart(2, "0")).join("");

function element(kind, className, text) {
    const made = document.createElement(kind);
    if (className) made.className = className;
    if (text !== undefined) made.textContent = text;
    return made;
}

// Said to those who hear the page.
function say(text) {
    part("spoken").textContent = text;
}

const kEyes =
    '<svg class="open" viewBox="0 0 20 20" aria-hidden="true"><path d="M2 10c2-4 5-5.500 8-5.500s6 1.500 8 5.500c-2 4-5 5.500-8 5.500s-6-1.500-8-5.500z"/><circle cx="10" cy="10" r="2.400"/></svg>' +
    '<svg class="shut" viewBox="0 0 20 20" aria-hidden="true"><path d="M2 9c2 3.500 5 5 8 5s6-1.500 8-5M10 14v2.500M4.500 12.500 3 14.500M15.500 12.500 17 14.500"/></svg>';

// A feature: its eye, and its shares in the saved view.
function featureButton(feature, isShown) {
    const button = element("button", "feature");
    button.type = "button";
    button.setAttribute("role", "switch");
    button.setAttribute("aria-checked", String(isShown));
    const line = element("span", "line");
    line.innerHTML = kEyes;
    const swatch = element("span", "swatch");
    swatch.style.background = hexOf(feature.color);
    line.append(swatch, element("span", "name", feature.name));
    button.append(line);
    let words = `Show ${feature.name}`;
    if (feature.vws !== undefined) {
        line.append(element("span", "share", percent(feature.vws)));
        const bars = element("span", "bars"), thick = element("i", "thick"), thin = element("i", "thin");
        thick.style.width = `${100 * feature.vws}%`;
        thick.style.background = hexOf(feature.color);
        thin.style.width = `${100 * feature.visibility}%`;
        bars.append(thick, thin);
        button.append(bars);
        words += `: ${percent(feature.vws)} of saliency, ${percent(feature.visibility)} of what is visible in the saved view`;
    }
    button.setAttribute("aria-label", words);
    return button;
}

// What can be read without drawing.
function showFigures(scene) {
    const { features } = scene.tf;
    part("features-part").hidden = features.length === 0;
    part("figures-note").hidden = !features.some(f => f.vws !== undefined);
    for (const feature of features) {
        const item = element("li"), button = featureButton(feature, !feature.hidden);
        button.disabled = true;
        item.append(button);
        part("features").append(item);
    }
}

// Two handles on one line: what is kept along an axis.
function cutRow(axis, name, viewer) {
    const row = element("div", "span"), both = element("div", "both"), value = element("span", "value");
    row.setAttribute("role", "group");
    row.setAttribute("aria-label", `Cut along ${name}`);
    const ends = ["lo", "hi"].map(end => {
        const input = element("input");
        Object.assign(input, { type: "range", min: 0, max: 100, step: 1 });
        input.setAttribute("aria-label", `${end === "lo" ? "From" : "To"}, along ${name}`);
        input.addEventListener("input", () => {
            const kLeast = 1, other = 100 * viewer.clip[end === "lo" ? "hi" : "lo"][axis];
            const now = end === "lo" ? Math.min(Number(input.value), other - kLeast) : Math.max(Number(input.value), other + kLeast);
            viewer.clip[end][axis] = now / 100;
            follow();
            viewer.change();
        });
        return input;
    });
    function follow() {
        const at = ["lo", "hi"].map(end => Math.round(100 * viewer.clip[end][axis]));
        ends.forEach((input, i) => {
            input.value = at[i];
            input.setAttribute("aria-valuetext", `${at[i]} %`);
        });
        both.style.setProperty("--lo", at[0]);
        both.style.setProperty("--hi", at[1]);
        value.textContent = `${at[0]}\u2013${at[1]} %`;
    }
    both.append(...ends);
    row.append(element("span", "", name), both, value);
    part("cuts").append(row);
    return follow;
}

// Connects the controls with the viewer. Returns what keys do.
function connectPanel(viewer) {
    const { scene } = viewer, { features } = scene.tf;
    const eyes = [...part("features").querySelectorAll("button")];
    const follows = ["x", "y", "z"].map((name, axis) => cutRow(axis, name, viewer));
    const density = part("density"), front = part("front"), light = part("light");
    for (const id of ["cut-part", "actions"]) part(id).hidden = false;
    part("density-part").hidden = !scene.density;

    const ends = scene.density && [scene.density.points[0], scene.density.points[scene.density.points.length - 1]].map(p => Math.log(p.coverage));
    const coverageOf = place => Math.exp(ends[0] + place / 1000 * (ends[1] - ends[0]));
    const placeOf = coverage => Math.round(1000 * (Math.log(coverage) - ends[0]) / (ends[1] - ends[0]));

    const act = {
        toggle(f) {
            if (f >= features.length) return;
            viewer.shown[f] = !viewer.shown[f];
            viewer.changeTf();
            follow();
            say(`${features[f].name} ${viewer.shown[f] ? "shown" : "hidden"}`);
        },
        stepDensity(way) {
            if (!scene.density) return;
            density.value = Number(density.value) + 50 * way;
            density.dispatchEvent(new Event("input"));
            say(`Density: ${density.getAttribute("aria-valuetext")}`);
        },
        switchLight() {
            viewer.light = !viewer.light;
            viewer.change();
            follow();
            say(`Light ${viewer.light ? "on" : "off"}`);
        },
        reset() {
            viewer.reset();
            follow();
            say("Saved view");
        },
        turned() {
            clearTimeout(act.waiting);
            act.waiting = setTimeout(() => {
                const { azimuth, elevation } = viewer.camera.angles();
                viewer.canvas.setAttribute("aria-label", `${scene.title}, azimuth ${Math.round(azimuth)}\u00b0, elevation ${Math.round(elevation)}\u00b0`);
            }, 300);
        },
    };

    eyes.forEach((button, f) => {
        button.disabled = false;
        button.addEventListener("click", () => act.toggle(f));
    });
    density.addEventListener("input", () => {
        viewer.setCoverage(coverageOf(Number(density.value)));
        followDensity();
    });
    front.addEventListener("input", () => {
        viewer.cutFront(Number(front.value) / 100);
        followFront();
    });
    light.addEventListener("change", act.switchLight);
    part("reset").addEventListener("click", act.reset);
    part("save").addEventListener("click", async () => {
        const canvas = await viewer.pictureAsSeen();
        const link = element("a");
        link.href = canvas.toDataURL("image/png");
        link.download = "picture.png";
        link.click();
    });

    function followDensity() {
        if (!scene.density) return;
        density.value = placeOf(viewer.coverage);
        const words = `${percent(viewer.coverage)} opaque`;
        density.setAttribute("aria-valuetext", words);
        part("density-value").textContent = words;
    }
    function followFront() {
        front.value = Math.round(100 * viewer.clip.front);
        front.setAttribute("aria-valuetext", `${front.value} %`);
        part("front-value").textContent = `${front.value} %`;
    }
    function follow() {
        eyes.forEach((button, f) => button.setAttribute("aria-checked", String(viewer.shown[f])));
        follows.forEach(one => one());
        light.checked = viewer.light;
        followDensity();
        followFront();
    }
    follow();
    act.turned();
    return act;
}

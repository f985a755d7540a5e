// SPDX-License-Identifier: MIT
#pragma once

#include "standard.h"

namespace topple::test {

// In the page: a click of the pointer where `wanted(part, object)` is seen, with the keys that are
// held; each is counted.
inline const std::string clicking = R"(
    const canvas = toppleView.renderer.domElement, box = canvas.getBoundingClientRect();
    let clicks = 0;
    const seen = wanted => {
        for (let x = 3; x < box.width; x += 4) for (let y = 3; y < box.height; y += 4) {
            const group = toppleView.pickGroup(x, y);
            if (group && wanted(...group)) return {clientX: box.left + x, clientY: box.top + y};
        }
        return null;
    };
    const click = (wanted, keys = {}) => {
        const at = seen(wanted);
        if (!at) { out.missed = String(wanted); return; }
        ++clicks;
        for (const type of ['pointerdown', 'pointerup'])
            canvas.dispatchEvent(new PointerEvent(type, {...at, ...keys, button: 0, bubbles: true, pointerId: 1}));
    };
    const press = selector => { ++clicks; document.querySelector(selector).click(); };
    const told = () => JSON.stringify(toppleParts.corrections.document());
    toppleView.render();
)";

}  // namespace topple::test

// SPDX-License-Identifier: MIT
'use strict';

// `topple view` tells when its folder has another output than before, as of a scan that `topple live` follows. That is
// shown at once, from where this one was looked at, unless somebody is putting something right here.
const keptSight = 'topple-sight';

function keepSight(view) {
  const {camera, controls} = view;
  sessionStorage.setItem(keptSight, JSON.stringify({position: camera.position.toArray(), target: controls.target.toArray()}));
}

function takeSight(view) {
  const kept = sessionStorage.getItem(keptSight);
  sessionStorage.removeItem(keptSight);
  if (!kept) return;
  const {position, target} = JSON.parse(kept);
  view.camera.position.fromArray(position);
  view.controls.target.fromArray(target);
  view.controls.update();
  view.redraw();
}

// busy(): whether something that was said here would be lost.
function followOutputs(view, busy) {
  if (location.protocol !== 'http:' || !['127.0.0.1', 'localhost'].includes(location.hostname)) return;
  if (view) takeSight(view);
  // Ids of objects are those of one output: what was chosen may be another one's there.
  const show = () => {
    if (view) keepSight(view);
    location.replace(location.pathname);
  };
  new EventSource('events').addEventListener('output', event => {
    // Milliseconds since 1970 by the clock of this machine, which is the server's.
    if (Number(event.data) <= performance.timeOrigin) return;
    if (!busy()) return show();
    document.getElementById('newer').hidden = false;
  });
  document.getElementById('show-newer').addEventListener('click', show);
}

/* Axonometric projection, as figures/axonometry.rs has it, of points whose third axis is up.

     u = -x sin a + y cos a                        to the right
     v = z cos e - (x cos a + y sin a) sin e       up                                                             */

const RAD = Math.PI / 180;

function projected([x, y, z], { azimuth, elevation }) {
  const [sa, ca, se, ce] = [Math.sin(azimuth * RAD), Math.cos(azimuth * RAD), Math.sin(elevation * RAD), Math.cos(elevation * RAD)];
  return [y * ca - x * sa, z * ce - (x * ca + y * sa) * se];
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const plus = (a, b, factor = 1) => a.map((value, k) => value + factor * b[k]);
const distance = (a, b) => Math.hypot(...a.map((value, k) => value - b[k]));

/* 1, 2 or 5 times a power of ten, no smaller than a length. */
function roundStep(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return power * [1, 2, 5, 10].find(factor => length <= factor * power * (1 + 1e-9));
}

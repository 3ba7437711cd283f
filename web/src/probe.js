// What tests may read: `window.mjarm`.
import { Vector3 } from 'three';

/** @param {object} page  parts of the page */
export function exposeProbe({ source, stage, eye, model, target, overlay, panels, selection, transport, last }) {
  const probe = {
    get connection() { return source.connection; },
    get ready() { return model.ready; },
    get frame() { return last.frame?.number ?? -1; },
    get time() { return last.frame?.time ?? 0; },
    get paused() { return transport.paused; },
    get speed() { return transport.speed; },
    get qpos() { return Array.from(last.frame?.qpos ?? []); },
    /** x y z, w x y z of each body. */
    get bodies() {
      const poses = last.frame?.bodies ?? new Float32Array(0);
      return Array.from({ length: poses.length / 7 }, (_, i) => Array.from(poses.subarray(7 * i, 7 * i + 7)));
    },
    get target() {
      const { shown, p, q, number, held, rgba } = target;
      return { shown, pos: p.toArray(), quat: [q.w, q.x, q.y, q.z], number, held, rgba: [...rgba] };
    },
    get overlay() { return overlay.items.map((item) => item.kind); },
    /** How many points each line has. */
    get lines() { return overlay.items.flatMap((item) => (item.kind === 'line' ? [item.points.length] : [])); },
    /** Of the checkboxes: id to whether it is on, as the server told them last. */
    get switches() {
      const items = panels.sections.flatMap((section) => section.items);
      return Object.fromEntries(items.filter(({ kind }) => kind === 'checkbox').map(({ id, on }) => [id, on]));
    },
    get selected() { return selection.body; },
    get groups() { return model.groups; },
    get camera() {
      const { lookat, distance, azimuth, elevation, chosen } = eye;
      return { lookat: lookat.toArray(), distance, azimuth, elevation, chosen };
    },
    /** Pixel of the window where a point of the world is seen. */
    project(point) {
      const box = stage.canvas.getBoundingClientRect();
      const { x, y, visible } = eye.project(new Vector3(...point));
      return { x: box.left + x, y: box.top + y, visible };
    },
    /** Pixel of a point of an arrow of the target: axis 0 to 2, share of its length. */
    handle(axis, share = 0.8) {
      const { x, y } = target.handlePixel(axis, share);
      const box = stage.canvas.getBoundingClientRect();
      return { x: box.left + x, y: box.top + y };
    },
  };
  Object.defineProperty(window, 'mjarm', { value: Object.freeze(probe) });
}

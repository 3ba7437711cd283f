// Where the page has its data from. Everything else of the page knows this interface alone.
import { Emitter } from './emitter.js';

/**
 * One moment of the world.
 * @typedef {object} Frame
 * @property {number} number  rising
 * @property {number} time    [s] of the simulation
 * @property {boolean} paused
 * @property {Float32Array} bodies  x y z [m], w x y z of each body in the world frame
 * @property {Float32Array} qpos    [rad or m]
 */

/**
 * How the page stands to what it shows: `connecting` at first, `open`, `lost` (it tries again),
 * `over` (the run has ended; the last frame stays).
 * @typedef {'connecting'|'open'|'lost'|'over'} Connection
 */

/**
 * Events (`on`): `hello`, `overlay`, `plots`, `panels`, `status`, `target`, `error`, `bye` with the
 * message of that type; `connection` with a {@link Connection}; `replaced` where what is shown is
 * another scene from now on, so that the page has to begin anew.
 */
export class Source extends Emitter {
  /** @type {Connection} */
  connection = 'connecting';

  /** The scene, once it is to be had. @returns {Promise<object>} */
  async scene() {
    throw new Error('not implemented');
  }

  /** The bytes of a mesh of the scene. @param {number} index @returns {Promise<ArrayBuffer>} */
  async mesh(index) {
    throw new Error(`not implemented: mesh ${index}`);
  }

  /** Begins to tell. */
  start() {}

  /** Does not wait for the next try. */
  retry() {}

  /** The newest frame that was not taken yet, else null. @returns {Frame|null} */
  takeFrame() {
    return null;
  }

  /**
   * What the user did; lost where there is no connection.
   * @param {{type: string}} message
   * @returns {boolean} whether it went off
   */
  send(message) {
    return Boolean(message) && false;
  }

  /** @param {Connection} connection */
  setConnection(connection) {
    if (connection === this.connection) return;
    this.connection = connection;
    this.emit('connection', connection);
  }
}

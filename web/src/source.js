// Where the page has its data from: an interface, which live_source.js and recorded_source.js fulfil.
// Everything else of the page knows this alone.

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
 * `over` (the run has ended; the last frame stays, and it tries again only where it is asked to).
 * @typedef {'connecting'|'open'|'lost'|'over'} Connection
 */

/**
 * @typedef {object} SourceParts
 * @property {Connection} connection
 * @property {() => Promise<object>} scene  once it is to be had
 * @property {(index: number) => Promise<ArrayBuffer>} mesh  the bytes of a mesh of the scene
 * @property {() => void} start  begins to tell
 * @property {() => void} retry  does not wait for the next try
 * @property {() => Frame|null} takeFrame  the newest one that was not taken yet
 * @property {(message: {type: string}) => boolean} send  what the user did; false where it is lost,
 *     as there is no connection
 */

/**
 * Events (`on`): `hello`, `overlay`, `plots`, `panels`, `status`, `target`, `error`, `bye` with the
 * message of that type; `connection` with a {@link Connection}; `replaced` where what is shown is
 * another scene from now on, so that the page has to begin anew.
 * @typedef {import('./emitter.js').Emitter & SourceParts} Source
 */

export {};

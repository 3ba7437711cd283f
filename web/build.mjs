// Bundles the page: web/dist/{index.html,page.js,page.css}, no other file is needed to show it.
import { build } from 'esbuild';
import { copyFile, mkdir, rm } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';

const here = fileURLToPath(new URL('.', import.meta.url));
const dist = `${here}dist`;

await rm(dist, { recursive: true, force: true });
await mkdir(dist, { recursive: true });
await build({
  absWorkingDir: here,
  entryPoints: { page: 'src/main.js' },
  outdir: dist,
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'eof',
  logLevel: 'info',
});
await build({
  absWorkingDir: here,
  entryPoints: { page: 'page.css' },
  outdir: dist,
  bundle: true,
  minify: true,
  charset: 'utf8',
  logLevel: 'info',
});
await copyFile(`${here}index.html`, `${dist}/index.html`);

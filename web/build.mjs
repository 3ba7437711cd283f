// Bundles the page: web/dist/{index.html,page.js,page.css}, no other file is needed to show it.
import { build } from 'esbuild';
import { copyFile, mkdir, readFile, rm } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';

const here = fileURLToPath(new URL('.', import.meta.url));
const dist = `${here}dist`;

/** The licences of what is bundled, which go along with it. */
async function licences(names) {
  const texts = await Promise.all(names.map((name) => readFile(`${here}node_modules/${name}/LICENSE`, 'utf8')));
  return `/*!\n${names.map((name, index) => `${name}\n\n${texts[index].trim()}`).join('\n\n\n')}\n*/`;
}

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
  legalComments: 'none',
  footer: { js: await licences(['three', 'uplot']) },
  logLevel: 'info',
});
await build({
  absWorkingDir: here,
  entryPoints: { page: 'page.css' },
  outdir: dist,
  bundle: true,
  minify: true,
  charset: 'utf8',
  footer: { css: await licences(['uplot']) },
  logLevel: 'info',
});
await copyFile(`${here}index.html`, `${dist}/index.html`);

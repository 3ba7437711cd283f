// Bundles the page: web/dist/{index.html,page.js,page.css}, no other file is needed to show it.
import { build } from 'esbuild';
import { copyFile, mkdir, readFile, rm } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';

const here = fileURLToPath(new URL('.', import.meta.url));
const dist = `${here}dist`;
const common = { absWorkingDir: here, outdir: dist, bundle: true, minify: true, charset: 'utf8', logLevel: 'info' };

/** The licences of what is bundled, which go along with it. */
async function licences(names) {
  const texts = await Promise.all(names.map((name) => readFile(`${here}node_modules/${name}/LICENSE`, 'utf8')));
  return `/*!\n${names.map((name, index) => `${name}\n\n${texts[index].trim()}`).join('\n\n\n')}\n*/`;
}

await rm(dist, { recursive: true, force: true });
await mkdir(dist, { recursive: true });
await build({
  ...common,
  entryPoints: { page: 'src/main.js' },
  format: 'esm',
  target: 'es2022',
  legalComments: 'none',
  footer: { js: await licences(['three', 'uplot']) },
});
await build({ ...common, entryPoints: { page: 'page.css' }, footer: { css: await licences(['uplot']) } });
await copyFile(`${here}index.html`, `${dist}/index.html`);

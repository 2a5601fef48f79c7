import { gzipSync } from 'node:zlib';
import { readFileSync, readdirSync, statSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { defineConfig, type Plugin } from 'vite';

// The shaders are those of rviz and endoscope_camera: they are read where they lie, not copied.
const media = process.env.VIBE_MEDIA ?? resolve(__dirname, '../../vibe_graphics/media');

function filesBelow(folder: string): string[] {
  return readdirSync(folder).flatMap((name) => {
    const path = join(folder, name);
    return statSync(path).isDirectory() ? filesBelow(path) : [path];
  });
}

/** Beside each file a compressed one, which the server prefers. */
function gzipped(): Plugin {
  let folder = '';
  return {
    name: 'gzipped',
    configResolved: (config) => void (folder = resolve(config.root, config.build.outDir)),
    closeBundle() {
      for (const file of filesBelow(folder))
        if (/\.(html|js|css|svg)$/.test(file)) writeFileSync(file + '.gz', gzipSync(readFileSync(file), { level: 9 }));
    },
  };
}

// `--mode viewer`: the viewer of reports, a script without modules, because a report has it in itself
export default defineConfig(({ mode }) => ({
  base: './',
  resolve: { alias: { '@media': media } },
  server: { fs: { allow: ['.', media] } },
  build: {
    target: 'es2021', assetsInlineLimit: 0, chunkSizeWarningLimit: 1200,
    ...(mode === 'viewer' ? { emptyOutDir: false, lib: { entry: 'src/viewer.ts', formats: ['iife'], name: 'viewer', fileName: () => 'viewer.js' } } : { emptyOutDir: true }),
  },
  plugins: mode === 'viewer' ? [] : [gzipped()],
}));

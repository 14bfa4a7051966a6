import { defineConfig } from 'vite';

export default defineConfig({
  // The page lies at any address: below a token, or in a folder of a site.
  base: './',
  worker: { format: 'es' },
  build: { target: 'es2023', chunkSizeWarningLimit: 1500, reportCompressedSize: false },
});

import { defineConfig } from "vitest/config";

// Page and worker come as a few files beside index.html; the server forbids everything that is loaded from elsewhere.
export default defineConfig({
  base: "./",
  build: { target: "es2022", outDir: "dist", emptyOutDir: true, modulePreload: false, chunkSizeWarningLimit: 1500 },
  worker: { format: "es" },
  test: { include: ["test/unit/**/*.test.ts"] },
});

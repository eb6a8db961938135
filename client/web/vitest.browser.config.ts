import { defineConfig } from "vitest/config";

// Against a real server and a real browser: one file at a time, for both want the machine for themselves.
export default defineConfig({
  test: { include: ["test/{browser,measure}/**/*.test.ts"], fileParallelism: false, testTimeout: 120_000, hookTimeout: 60_000, expect: { poll: { timeout: 30_000 } } },
});

/** What buffers may be used for, as WebGPU numbers it: the constants of `GPUBufferUsage`, of which types are not everywhere. */
export const Usage = { MAP_READ: 1, COPY_SRC: 4, COPY_DST: 8, VERTEX: 0x20, UNIFORM: 0x40, STORAGE: 0x80, INDIRECT: 0x100, QUERY_RESOLVE: 0x200 } as const;

/** `GPUMapMode.READ`. */
export const READ = 1;

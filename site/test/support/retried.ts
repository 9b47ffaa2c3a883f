/**
 * For requests: the server closes a connection that was idle for five seconds, which on a busy machine happens while the
 * next request is sent.
 */
export const RETRIED = { maxRetries: 3 };

/** Whether the visitor wants less motion; its changes. */
export const motionQuery: MediaQueryList = matchMedia("(prefers-reduced-motion: reduce)");

export const reducesMotion = (): boolean => motionQuery.matches;

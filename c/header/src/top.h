// sweep-and-prune: finds every overlapping pair of axis-aligned boxes, fast.
//
// Written by c/header from the Rust sources: do not edit.
//
// There are four kinds of boxes: 3f and 2f (3D and 2D, float), 3d and 2d (3D and 2D, double). Each has the same functions:
//
//     sap_finder3f    finds all pairs of one set of boxes, or of two sets
//     sap_world3f     the persistent broad phase: keeps bodies, and reports which overlaps begin and end
//
// Rules for all functions:
//
// Errors. A function that can fail returns a status, and SAP_OK is 0. Its last argument points to an error, which says in words
// what was wrong; it may be NULL. It is written only if the call fails. After a failed call nothing has changed, and no result
// has been written (SAP_ERROR_PANIC is an exception, see there). There is no global state.
//
// Handles. A handle is created by `create` and destroyed by `destroy`, which sets your pointer to NULL. NULL and a handle of
// another type are errors. A handle that was destroyed may not be used, as memory that was freed; copies of the pointer are
// your concern.
//
// Threads. Different handles can be used by different threads at the same time. One handle can be moved from thread to thread.
// Functions that take a `const` handle can run at the same time as each other, and so can queries of a prepared world
// (sap_world3f_prepare_queries). Any other call while one is running returns SAP_ERROR_BUSY and does nothing.
//
// Memory. What a function reads, it reads during the call only. Arrays that the library owns say how long they are valid. A
// function that writes a list takes the capacity of your array and says how many items there are in all; if there are more
// than fit, the first ones are written, and you can call it again with a larger array.
//
// Pointers. They must point to what their type says, for as many items as the count says, and be aligned for it. An array of
// count 0 may be NULL.

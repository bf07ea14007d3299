"""From models that programs and people make to meshes that a microcontroller draws from flash.

The way of the data: `obj` reads a file, `model` assembles triangles from it (with `triangulate`, `normals`, `texture`),
`mesh` quantises and welds them, `header` and `elm` write the result, `command` is the command line around all that.
"""

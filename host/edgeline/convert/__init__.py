"""From models that programs and people make to meshes that a microcontroller draws from flash.

The way of the data: `obj` with `model`, `stl`, `ply`, and `gltf` with `gltf_file`, read a file into a `source` (with
`triangulate`); `simplify` makes it smaller (with `nearest`), `normals` smooth; `mesh` quantises and welds, `clusters`
puts in order, `header` and `elm` write. Its pictures become textures: `texture` reads them and makes `texels`, with the
colours of `palette`; `atlas` joins them, `materials` knows what was asked for. `pipeline` is that way; `command` and
`preview` are command lines around it, `report` what they say, with `locality` and `estimate`.
"""

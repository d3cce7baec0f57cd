// The include in a fragment shader, as a game has it.
#ifdef GL_ES
precision highp float;
precision highp int;
precision highp sampler3D;
#endif
uniform sampler3D g_volume0, g_volume1, g_volume2;
uniform sampler2D g_tiles;
#define DRTV_FETCH(k, uvw) ((k) == 0 ? texture(g_volume0, uvw) : (k) == 1 ? texture(g_volume1, uvw) : texture(g_volume2, uvw))
#define DRTV_FETCH_TILE(column) texelFetch(g_tiles, column, 0).xy
// HERE
uniform DrtvVolume g_volume;
uniform DrtvTiles g_sky;
uniform DrtvColours g_far, g_room;
uniform float g_share;
in vec3 g_place;
in vec3 g_normal;
out vec4 g_colour;

void main() {
    DrtvColours outdoors = drtv_outdoors(g_volume, g_sky, g_far, g_place);
    g_colour = vec4(drtv_ambient(DRTV_ACCURATE, outdoors, g_room, g_share, normalize(g_normal)), 1.0);
}

in vec3 position;   // of the cube −½ … ½
in vec3 normal;
in vec4 place;      // per box: centre; w: unused
in vec4 extent;     // per box: size; w: unused
in vec2 turn;       // per box: cosine and sine of the heading

vec3 turned(vec3 v) { return vec3(turn.x * v.x + turn.y * v.z, v.y, turn.x * v.z - turn.y * v.x); }
vec3 placed() { return place.xyz + turned(position * extent.xyz); }

/** The build puts the text of a shader in its place. */
declare module "*.wgsl" {
  const code: string;
  export default code;
}

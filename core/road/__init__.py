"""Where the road is: profiles, curbs, edges, surface."""
